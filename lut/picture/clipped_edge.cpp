// SPDX-License-Identifier: MIT
#include "lut/picture/clipped_edge.h"

#include <algorithm>
#include <cmath>

#include "lut/picture/tone_curve.h"

namespace alpenglow {
namespace {

constexpr float kLeastLight = 16.0F, kFullLight = 256.0F;  // of white
constexpr float kEven = 0.4F;  // of the light, in its square: the limb is half as bright
constexpr int kToLight = 4, kToBeside = 4;  // pixels: filters spread an edge over four

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

/// The mean colour of what is not clipped, by nearness; nothing where all is.
std::optional<std::array<float, 3>> Beside(const Image& image, const Pixel& at, float white) {
  std::array<float, 3> sum{};
  float weights = 0.0F;
  Around(image, at, kToBeside, [&](const Pixel& pixel) {
    if (LuminanceAt(image, pixel.x, pixel.y) > white) return;
    const int dx = pixel.x - at.x, dy = pixel.y - at.y;
    const float weight = 1.0F / static_cast<float>(dx * dx + dy * dy + 1);
    const auto& rgb = image.at(pixel.x, pixel.y);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * rgb[c];
    weights += weight;
  });
  if (weights == 0.0F) return std::nullopt;
  for (float& channel : sum) channel /= weights;
  return sum;
}

}  // namespace

std::optional<ClippedEdge> ClippedEdgeAt(const Image& image, int x, int y, float white) {
  const float here = LuminanceAt(image, x, y);
  if (here <= white) return std::nullopt;
  Pixel brightest{x, y};
  float light = here;
  Around(image, {x, y}, kToLight, [&](const Pixel& pixel) {
    const float luminance = LuminanceAt(image, pixel.x, pixel.y);
    if (luminance <= light) return;
    light = luminance;
    brightest = pixel;
  });
  if (light <= kLeastLight * white || !IsEven(image, brightest.x, brightest.y, light)) {
    return std::nullopt;
  }
  const std::optional<std::array<float, 3>> beside = Beside(image, {x, y}, white);
  if (!beside) return std::nullopt;
  const float dark = shared::Luminance((*beside)[0], (*beside)[1], (*beside)[2]);
  const float stops = std::log2(light / (kLeastLight * white));
  return ClippedEdge{image.at(brightest.x, brightest.y), *beside,
                     std::clamp((here - dark) / (light - dark), 0.0F, 1.0F),
                     std::min(stops / std::log2(kFullLight / kLeastLight), 1.0F)};
}

}  // namespace alpenglow
