// SPDX-License-Identifier: MIT
#include "renderer/effects/effect_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alpenglow::renderer {
namespace {

Image Grey(float value) {
  Image image(20, 10);
  for (auto& rgb : image.rgb) rgb = {value, value, value};
  return image;
}

TEST(PictureChange, IsTheRelativeErrorOfSmallChanges) {
  const PictureChange change = ChangeOf(Grey(100.0F), Grey(101.0F));
  EXPECT_NEAR(change.rms, 0.01, 1e-4) << "against the mean of both";
  EXPECT_NEAR(change.at_99_percent, 0.01, 1e-4);
  EXPECT_EQ(ChangeOf(Grey(100.0F), Grey(100.0F)).rms, 0.0);
}

TEST(PictureChange, IsTheSameBothWaysAndAtMostTwo) {
  EXPECT_EQ(PixelChange({1.0F, 2.0F, 3.0F}, {2.0F, 2.0F, 0.0F}, 0.1),
            PixelChange({2.0F, 2.0F, 0.0F}, {1.0F, 2.0F, 3.0F}, 0.1));
  EXPECT_EQ(PixelChange({5.0F, 5.0F, 5.0F}, {0.0F, 0.0F, 0.0F}, 0.1), 2.0);
  EXPECT_EQ(PixelChange({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 0.1), 0.0);
}

TEST(PictureChange, WhatIsDarkInThePictureCountsLess) {
  // Half the pixels are middle grey; the others, 1/1000 of it, double.
  Image reference = Grey(100.0F), other = Grey(100.0F);
  for (std::size_t i = 0; i < reference.rgb.size(); i += 4) {
    reference.rgb[i] = {0.1F, 0.1F, 0.1F};
    other.rgb[i] = {0.2F, 0.2F, 0.2F};
  }
  EXPECT_NEAR(ChangeFloor(reference), 100.0 / 16.0, 0.5) << "four steps below what is metered";
  EXPECT_LT(ChangeOf(reference, other).rms, 0.02);
}

TEST(PictureChange, ColourCountsAtTheSameLuminance) {
  EXPECT_GT(PixelChange({0.0F, 0.1F, 1.0F}, {0.23F, 0.1F, 0.3F}, 0.01), 0.5);
}

TEST(PictureChange, ASampleBoundsTheWholeThatItIsDrawnFrom) {
  // Changes of up to a percent and, in one pixel of 20, ten times as much.
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const double squares = 1e-4 / 3.0 * (0.95 + 0.05 * 100.0);
  int bounded = 0;
  for (int start = 0; start < 1000; ++start) {
    std::vector<double> sample;
    for (int i = 0; i < 400; ++i) sample.push_back(0.01 * unit() * (unit() < 0.05 ? 10.0 : 1.0));
    const ChangeEstimate estimate = ChangeEstimate::Of(sample);
    bounded += estimate.at_most.rms >= std::sqrt(squares) ? 1 : 0;
    EXPECT_GE(estimate.at_most.rms, estimate.seen.rms);
    EXPECT_GE(estimate.at_most.at_99_percent, estimate.seen.at_99_percent);
  }
  EXPECT_GE(bounded, 970) << "three standard errors, of a few large changes";
}

}  // namespace
}  // namespace alpenglow::renderer
