// SPDX-License-Identifier: MIT
#include "lut/image/clipped_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

constexpr float kLeastLight = 16.0F, kFullLight = 256.0F;  // times white
constexpr float kEven = 0.4F;         // of the light, in its square; the limb is half as bright
constexpr float kDarkestLimb = 0.4F;  // fraction of the light four pixels farther in
// Search distances [pixels]: filters spread an edge over three or four pixels.
constexpr int kToLight = 4, kToBeside = 4;
// Squared radii near 2 and 4 pixels. They are squared lengths of knight's moves, so that in every
// direction some pixel lies at about that distance.
constexpr int kToLimb2 = 5, kToLight2 = 20;
// An aureole brightens towards its sun. From the farther background pixels (more than the root of
// kToFar2 away) to the nearer ones it brightens by a factor, and from those to the pixel by about
// the square of this factor. A factor above kSteepest indicates the edge of another object.
constexpr int kToFar2 = 10;
constexpr float kSteepest = 1.6F;
// The outer taps of a filter add a little of the light to some unclipped pixels too. Such a pixel
// is brighter than its background by at least this factor.
constexpr float kTouched = 1.25F;

float LuminanceAt(const HdrImage& image, int x, int y) {
  const auto& rgb = image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  return shared::Luminance(rgb[0], rgb[1], rgb[2]);
}

/// Returns whether a pixel belongs to a 2x2 square of pixels that are about as bright.
bool IsEven(const HdrImage& image, int x, int y, float light) {
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

/// Calls visit(pixel) for all pixels at most `reach` rows and columns away from `at`.
template <typename Visit>
void Around(const HdrImage& image, const Pixel& at, int reach, const Visit& visit) {
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

/// Returns the brightest pixel within the square root of `reach2`.
EdgeLight BrightestAround(const HdrImage& image, const Pixel& at, int reach2) {
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

/// Returns the unit vector away from the light around a pixel; zero if the light is equal on all
/// sides.
EdgeDirection AwayFromLight(const HdrImage& image, const Pixel& at) {
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

/// A weighted mean of colours.
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

/// Returns the factor by which an aureole brightens from the background pixels, near and far, to
/// the pixel itself.
float RiseTowardsLight(const MeanColour& near, const MeanColour& far) {
  if (near.empty() || far.empty()) return 1.0F;
  const float rise = near.Luminance() / std::max(far.Luminance(), 1e-30F);
  return rise > 1.0F && rise < kSteepest ? rise * rise : 1.0F;
}

/// Returns the colour of the unclipped background, extrapolated to the pixel. It is a mean over
/// unclipped pixels, weighted by proximity and by the fourth power of the cosine between their
/// direction and the direction away from the light, times the rise of the aureole. If no pixel lies
/// in that direction, the mean is weighted by proximity alone. Returns nullopt if all pixels are
/// clipped.
std::optional<std::array<float, 3>> Beside(const HdrImage& image, const Pixel& at, float white) {
  const EdgeDirection away = AwayFromLight(image, at);
  MeanColour behind, around, near, far;
  Around(image, at, kToBeside, [&](const Pixel& pixel) {
    if (LuminanceAt(image, pixel.x, pixel.y) > white) return;
    const auto dx = static_cast<float>(pixel.x - at.x), dy = static_cast<float>(pixel.y - at.y);
    const float distance2 = dx * dx + dy * dy;
    if (distance2 == 0.0F) return;
    // Pixels in which a filter mixes the light count only if there are none farther away.
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

std::optional<ClippedEdge> ClippedEdgeAt(const HdrImage& image, int x, int y, float white) {
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
