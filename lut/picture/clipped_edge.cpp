// SPDX-License-Identifier: MIT
#include "lut/picture/clipped_edge.h"

#include <algorithm>
#include <cmath>

#include "lut/picture/tone_curve.h"

namespace alpenglow::lut {
namespace {

constexpr float kLeastLight = 16.0F, kFullLight = 256.0F;  // of white
constexpr float kEven = 0.4F;         // of the light, in its square: the limb is half as bright
constexpr float kDarkestLimb = 0.4F;  // of the light four pixels farther in
// Pixels: filters spread an edge over three or four.
constexpr int kToLight = 4, kToBeside = 4;
// Squares of 2 and 4 pixels, and of the knight's move that is nearest to each: in all directions
// some pixel is about as far.
constexpr int kToLimb2 = 5, kToLight2 = 20;
// An aureole rises towards its sun: from the farther pixels behind (over the root of kToFar2 away) to
// the nearer ones it grows by a factor, and on to the pixel by about its square. More than kSteepest
// is the edge of something else.
constexpr int kToFar2 = 10;
constexpr float kSteepest = 1.6F;
// The far ends of a filter let a pixel that is not clipped have a little of the light, too: there it
// is so much brighter than what lies behind.
constexpr float kTouched = 1.25F;

float LuminanceAt(const Image& image, int x, int y) {
  const auto& rgb = image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  return shared::Luminance(rgb[0], rgb[1], rgb[2]);
}

/// Whether a pixel stands in a square of four that is as bright.
bool IsEven(const Image& image, int x, int y, float light) {
  const auto bright = [&](int i, int j) { return LuminanceAt(image, i, j) >= kEven * light; };
  for (const int i : {x - 1, x + 1}) {
    for (const int j : {y - 1, y + 1}) {
      if (bright(i, y) && bright(x, j) && bright(i, j)) return true;
    }
  }
  return false;
}

struct Pixel {
  int x, y;
};

/// Calls visit(pixel) for all within some pixels of a place.
template <typename Visit>
void Around(const Image& image, const Pixel& at, int reach, const Visit& visit) {
  for (int y = std::max(at.y - reach, 0); y <= std::min(at.y + reach, image.height - 1); ++y) {
    for (int x = std::max(at.x - reach, 0); x <= std::min(at.x + reach, image.width - 1); ++x) {
      visit(Pixel{x, y});
    }
  }
}

struct EdgeLight {
  Pixel at;
  float luminance;
};

/// Within the root of `reach2`.
EdgeLight BrightestAround(const Image& image, const Pixel& at, int reach2) {
  EdgeLight light{at, LuminanceAt(image, at.x, at.y)};
  Around(image, at, kToLight, [&](const Pixel& pixel) {
    const int dx = pixel.x - at.x, dy = pixel.y - at.y;
    const float luminance = LuminanceAt(image, pixel.x, pixel.y);
    if (dx * dx + dy * dy <= reach2 && luminance > light.luminance) light = {pixel, luminance};
  });
  return light;
}

struct EdgeDirection {
  float x, y;
};

/// Away from the light around a pixel, unit; zero where it lies on all sides alike.
EdgeDirection AwayFromLight(const Image& image, const Pixel& at) {
  EdgeDirection away{0.0F, 0.0F};
  Around(image, at, kToBeside, [&](const Pixel& pixel) {
    const float luminance = LuminanceAt(image, pixel.x, pixel.y);
    away.x -= luminance * static_cast<float>(pixel.x - at.x);
    away.y -= luminance * static_cast<float>(pixel.y - at.y);
  });
  const float length = std::hypot(away.x, away.y);
  return length > 0.0F ? EdgeDirection{away.x / length, away.y / length}
                       : EdgeDirection{0.0F, 0.0F};
}

/// Mean of colours.
class MeanColour {
 public:
  void Add(const std::array<float, 3>& rgb, float weight) {
    for (std::size_t c = 0; c < 3; ++c) sum_[c] += weight * rgb[c];
    weights_ += weight;
  }
  [[nodiscard]] bool empty() const { return weights_ == 0.0F; }
  [[nodiscard]] std::array<float, 3> Value() const {
    return {sum_[0] / weights_, sum_[1] / weights_, sum_[2] / weights_};
  }
  [[nodiscard]] float Luminance() const {
    const auto rgb = Value();
    return shared::Luminance(rgb[0], rgb[1], rgb[2]);
  }

 private:
  std::array<float, 3> sum_{};
  float weights_ = 0.0F;
};

/// By what an aureole grows from the pixels behind, near and far, to the pixel itself.
float RiseTowardsLight(const MeanColour& near, const MeanColour& far) {
  if (near.empty() || far.empty()) return 1.0F;
  const float rise = near.Luminance() / std::max(far.Luminance(), 1e-30F);
  return rise > 1.0F && rise < kSteepest ? rise * rise : 1.0F;
}

/// The colour of what is not clipped, as it would be at the pixel: the mean by nearness and, to the
/// fourth power, by the cosine with the way from the light, with the rise of its aureole; by nearness
/// alone where nothing lies that way; nothing where all is clipped.
std::optional<std::array<float, 3>> Beside(const Image& image, const Pixel& at, float white) {
  const EdgeDirection away = AwayFromLight(image, at);
  MeanColour behind, around, near, far;
  Around(image, at, kToBeside, [&](const Pixel& pixel) {
    if (LuminanceAt(image, pixel.x, pixel.y) > white) return;
    const auto dx = static_cast<float>(pixel.x - at.x), dy = static_cast<float>(pixel.y - at.y);
    const float distance2 = dx * dx + dy * dy;
    if (distance2 == 0.0F) return;
    // What a filter mixes with the light counts only where nothing farther off is there.
    const bool mixed = distance2 < static_cast<float>(kToLimb2);
    const float weight = (mixed ? 1e-6F : 1.0F) / distance2;
    const float cosine = std::max(away.x * dx + away.y * dy, 0.0F) / std::sqrt(distance2);
    const float along = cosine * cosine * cosine * cosine;
    const auto& rgb = image.at(pixel.x, pixel.y);
    around.Add(rgb, weight);
    behind.Add(rgb, weight * along);
    if (!mixed) (distance2 > static_cast<float>(kToFar2) ? far : near).Add(rgb, along);
  });
  if (around.empty()) return std::nullopt;
  std::array<float, 3> colour = (behind.empty() ? around : behind).Value();
  for (float& channel : colour) channel *= RiseTowardsLight(near, far);
  return colour;
}

}  // namespace

std::optional<ClippedEdge> ClippedEdgeAt(const Image& image, int x, int y, float white) {
  const float here = LuminanceAt(image, x, y);
  const auto clips = [&](int dx, int dy) { return LuminanceAt(image, x + dx, y + dy) > white; };
  if (!clips(0, 0) && !clips(-2, 0) && !clips(2, 0) && !clips(0, -2) && !clips(0, 2)) {
    return std::nullopt;
  }
  const EdgeLight light = BrightestAround(image, {x, y}, kToLight2);
  if (light.luminance <= kLeastLight * white ||
      !IsEven(image, light.at.x, light.at.y, light.luminance)) {
    return std::nullopt;
  }
  const std::optional<std::array<float, 3>> beside = Beside(image, {x, y}, white);
  if (!beside) return std::nullopt;
  const float dark = shared::Luminance((*beside)[0], (*beside)[1], (*beside)[2]);
  if (dark >= white || (here <= white && here < kTouched * dark)) return std::nullopt;
  const float within = BrightestAround(image, {x, y}, kToLimb2).luminance;
  const float full =
      std::max(3.0F * within - 2.0F * light.luminance, kDarkestLimb * light.luminance);
  const float stops = std::log2(light.luminance / (kLeastLight * white));
  const float seen = std::clamp(2.0F * (1.0F - dark / white), 0.0F, 1.0F);
  return ClippedEdge{image.at(light.at.x, light.at.y), *beside,
                     std::clamp((here - dark) / (full - dark), 0.0F, 1.0F),
                     seen * std::min(stops / std::log2(kFullLight / kLeastLight), 1.0F)};
}

}  // namespace alpenglow::lut
