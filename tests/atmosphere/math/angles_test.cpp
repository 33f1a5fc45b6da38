// SPDX-License-Identifier: MIT
#include "atmosphere/math/angles.h"

#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

TEST(AngleBetween, IsAccurateForParallelAndOppositeVectors) {
  const glm::dvec3 ahead(0.0, 0.0, 2.0);
  for (const double angle : {0.0, 1e-9, 1e-4, 0.5, 2.0, kPi - 1e-9, kPi}) {
    const glm::dvec3 other(3.0 * std::sin(angle), 0.0, 3.0 * std::cos(angle));
    EXPECT_NEAR(AngleBetween(ahead, other), angle, 1e-15 + 1e-15 * angle) << "rounding";
  }
}

TEST(DipOfHorizon, LineOfSightTouchesTheSphere) {
  constexpr double kRadius = 6371.0;
  EXPECT_EQ(DipOfHorizon(0.0, kRadius), 0.0);
  for (const double height : {1e-6, 0.002, 9.0, 400.0, 1e6}) {
    const double touching = (kRadius + height) * std::cos(DipOfHorizon(height, kRadius + height));
    EXPECT_NEAR(touching, kRadius, 1e-12 * kRadius) << "rounding";
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
