// SPDX-License-Identifier: MIT
#include "viewer/passes/tone_map_pass.h"

#include <gtest/gtest.h>

#include "lut/image/image.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

using SpotMeterTest = tests::Headless;

/// Grey, of so many candela per square metre in the upper left and one more from pixel to pixel.
RenderTarget Greys(int width, int height, float first_cd_per_m2) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i].fill(first_cd_per_m2 + static_cast<float>(i));
  RenderTarget target(width, height, RenderTarget::Depth::kNone);
  target.Write(image);
  return target;
}

// Luminance of grey is its value but for the rounding of three weights that add up to one.
constexpr double kRounding = 1e-3;

TEST_F(SpotMeterTest, TellsThePixelThatWasPointedAtOnceItHasArrived) {
  const RenderTarget picture = Greys(7, 5, 100.0F);
  SpotMeter meter;
  EXPECT_EQ(meter.At(picture, 0.5, 0.5), std::nullopt) << "nothing is waited for";
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.0, 0.0).value(), 100.0 + 2 * 7 + 3, kRounding);
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.999, 0.999).value(), 100.0, kRounding) << "row 0 is the highest";
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.0, 0.0).value(), 100.0 + 34, kRounding);
}

TEST_F(SpotMeterTest, KeepsItsValueUntilTheNextArrivesAndForgetsItWhenNothingIsPointedAt) {
  const RenderTarget picture = Greys(3, 3, 50.0F), other = Greys(3, 3, 900.0F);
  SpotMeter meter;
  static_cast<void>(meter.At(picture, 0.0, 0.0));
  glFinish();
  static_cast<void>(meter.At(other, 0.0, 0.0));
  meter.Leave();
  glFinish();
  EXPECT_EQ(meter.At(picture, 0.9, 0.0), std::nullopt) << "neither of before";
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.0, 0.0).value(), 52.0, kRounding);
}

}  // namespace
}  // namespace alpenglow::viewer
