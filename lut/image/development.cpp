// SPDX-License-Identifier: MIT
#include "lut/image/development.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "atmosphere/base/error.h"
#include "lut/image/clipped_edge.h"
#include "lut/image/dither.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

void RequireFinite(const std::array<float, 3>& pixel, int x, int y) {
  if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) return;
  throw InternalError(fmt::format("pixel ({}, {}) is ({}, {}, {}), which is no colour", x, y,
                                  pixel[0], pixel[1], pixel[2]));
}

/// Returns the display light of a pixel. At the edge of a disk that is far brighter than white it
/// is mixed from the display light of the disk and of its background.
Rgb<float> DisplayLightAt(const HdrImage& image, int x, int y, float scale, const Look& look) {
  const auto shown = [&](const std::array<float, 3>& rgb) {
    return DisplayLight(look.curve, rgb, scale, look.agx);
  };
  const std::optional<ClippedEdge> edge = ClippedEdgeAt(image, x, y, 1.0F / scale);
  const Rgb<float> whole = shown(image.at(x, y));
  if (!edge) return whole;
  const Rgb<float> light = shown(edge->light), beside = shown(edge->beside);
  Rgb<float> mixed;
  for (std::size_t c = 0; c < 3; ++c) {
    const float parts = edge->share * light[c] + (1.0F - edge->share) * beside[c];
    mixed[c] = edge->weight * parts + (1.0F - edge->weight) * whole[c];
  }
  return mixed;
}

void DevelopRow(const HdrImage& image, int y, float scale, const Look& look,
                DisplayImage& display) {
  for (int x = 0; x < image.width; ++x) {
    const std::array<float, 3>& pixel = image.at(x, y);
    RequireFinite(pixel, x, y);
    const Rgb<float> light = DisplayLightAt(image, x, y, scale, look);
    const auto index = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x));
    for (std::size_t c = 0; c < 3; ++c) {
      const float code = 255.0F * shared::SrgbCode(light[c]);
      display.rgb[index + c] = DitheredCode(code, DitherNoise(x, y, static_cast<int>(c)));
    }
  }
}

}  // namespace

DisplayImage Develop(const HdrImage& seen, double ev100, const Look& look) {
  if (look.local_exposure) {
    Look rest = look;
    rest.local_exposure = false;
    return Develop(LocallyExposed(seen, ev100), ev100, rest);
  }
  if (look.rolls_off) {
    Look rest = look;
    rest.rolls_off = false;
    return Develop(WithHighlightsRolledOff(seen, ev100), ev100, rest);
  }
  const auto scale = static_cast<float>(ExposureScale(ev100));
  DisplayImage display{seen.width, seen.height, std::vector<std::uint8_t>(3 * seen.rgb.size())};
  tbb::parallel_for(0, seen.height, [&](int y) { DevelopRow(seen, y, scale, look, display); });
  return display;
}

}  // namespace alpenglow::lut
