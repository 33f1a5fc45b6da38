// SPDX-License-Identifier: MIT
#include "lut/image/local_exposure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alpenglow::lut {
namespace {

// What is so many stops over what EV 12 prints as grey.
std::array<float, 3> At(double stops) {
  const auto y = static_cast<float>(0.125 * std::exp2(12.0 + stops));
  return {y, y, y};
}

float RolledOff(double stops) {
  Image image(1, 1);
  image.rgb = {At(stops)};
  return WithHighlightsRolledOff(image, 12.0).rgb[0][1];
}

TEST(Highlights, AreTheLogarithmOfTheirStopsOverGrey) {
  for (const double stops : {0.01, 1.0, 3.0, 6.0, 20.0})
    EXPECT_NEAR(RolledOff(stops) / At(std::log1p(stops))[1], 1.0, 2e-6) << stops << " stops, float";
}

TEST(Highlights, WhatIsDarkerThanGreyStays) {
  for (const double stops : {-10.0, -1.0, 0.0}) EXPECT_EQ(RolledOff(stops), At(stops)[1]);
}

TEST(Highlights, KeepTheirColour) {
  Image image(1, 1);
  image.rgb = {{4000.0F, 8000.0F, 16000.0F}};
  const std::array<float, 3> rgb = WithHighlightsRolledOff(image, 12.0).rgb[0];
  EXPECT_FLOAT_EQ(rgb[1] / rgb[0], 2.0F);
  EXPECT_FLOAT_EQ(rgb[2] / rgb[1], 2.0F);
}

}  // namespace
}  // namespace alpenglow::lut
