// SPDX-License-Identifier: MIT
#include "renderer/terrain/lattice_noise.h"

#include <gtest/gtest.h>

namespace alpenglow::renderer {
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

TEST(LatticeNoise, WithFewerOperationsIsTheSameNoise) {
  for (int i = 0; i < 200; ++i) {
    const auto bits = static_cast<std::uint32_t>(i);
    const std::uint32_t sw = shared::MixedBits(bits), se = shared::MixedBits(sw);
    const std::uint32_t nw = shared::MixedBits(se), ne = shared::MixedBits(nw);
    const double dx = 0.0049 * i, dy = 1.0 - 0.0037 * i;
    EXPECT_NEAR(shared::NoiseOfHashes(sw, se, nw, ne, dx, dy),
                shared::NoiseInCell(sw, se, nw, ne, dx, dy), 1e-14)
        << "another order of the same sums";
    EXPECT_NEAR(shared::SlopeOfHashesEast(sw, se, nw, ne, dx, dy),
                shared::NoiseSlopeEast(sw, se, nw, ne, dx, dy), 1e-14);
    EXPECT_NEAR(shared::SlopeOfHashesNorth(sw, se, nw, ne, dx, dy),
                shared::NoiseSlopeNorth(sw, se, nw, ne, dx, dy), 1e-14);
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
}  // namespace alpenglow::renderer
