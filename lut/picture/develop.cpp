// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "atmosphere/text/error.h"
#include "lut/picture/dither.h"
#include "lut/picture/image.h"
#include "lut/picture/tone_curve.h"

namespace alpenglow {
namespace {

void RequireFinite(const std::array<float, 3>& pixel, int x, int y) {
  if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) return;
  throw InternalError(fmt::format("pixel ({}, {}) is ({}, {}, {}), which is no colour", x, y,
                                  pixel[0], pixel[1], pixel[2]));
}

void DevelopRow(const Image& image, int y, float scale, ToneCurve curve, DisplayImage& display) {
  for (int x = 0; x < image.width; ++x) {
    const std::array<float, 3>& pixel = image.at(x, y);
    RequireFinite(pixel, x, y);
    const Rgb<float> light = DisplayLight(curve, pixel, scale);
    const auto index = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x));
    for (std::size_t c = 0; c < 3; ++c) {
      const float code = 255.0F * shared::SrgbCode(light[c]);
      display.rgb[index + c] = DitheredCode(code, DitherNoise(x, y, static_cast<int>(c)));
    }
  }
}

}  // namespace

DisplayImage Develop(const Image& image, double ev100, ToneCurve curve) {
  const auto scale = static_cast<float>(ExposureScale(ev100));
  DisplayImage display{image.width, image.height, std::vector<std::uint8_t>(3 * image.rgb.size())};
  tbb::parallel_for(0, image.height, [&](int y) { DevelopRow(image, y, scale, curve, display); });
  return display;
}

}  // namespace alpenglow
