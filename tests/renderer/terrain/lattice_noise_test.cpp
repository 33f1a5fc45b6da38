// SPDX-License-Identifier: MIT
#include "renderer/terrain/lattice_noise.h"

#include <gtest/gtest.h>

namespace alpenglow {
namespace {

TEST(LatticeNoise, SlopesAreTheDifferencesOfNearbyValues) {
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 500; ++i) {
    const double x = -7.0 + 0.0531 * i;
    const double y = 3.0 - 0.0377 * i;
    const NoiseSlope noise = GradientNoiseSlope(x, y, 5U);
    EXPECT_EQ(noise.value, GradientNoise(x, y, 5U)) << "one formula";
    const double by_x = GradientNoise(x + kStep, y, 5U) - GradientNoise(x - kStep, y, 5U);
    const double by_y = GradientNoise(x, y + kStep, 5U) - GradientNoise(x, y - kStep, 5U);
    EXPECT_NEAR(noise.by_x, by_x / (2.0 * kStep), 1e-7)
        << "step^2 times the third derivative, which jumps across lattice lines";
    EXPECT_NEAR(noise.by_y, by_y / (2.0 * kStep), 1e-7);
  }
}

TEST(LatticeNoise, IsZeroAtTheLatticePointsAndStaysWithinOne) {
  for (int i = -5; i < 5; ++i) EXPECT_EQ(GradientNoise(i, 3 * i, 9U), 0.0);
  for (int i = 0; i < 2000; ++i) {
    const double noise = GradientNoise(0.137 * i - 90.0, 0.071 * i, 9U);
    EXPECT_LT(noise, 1.0);
    EXPECT_GT(noise, -1.0);
  }
}

}  // namespace
}  // namespace alpenglow
