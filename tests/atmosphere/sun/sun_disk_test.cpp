// SPDX-License-Identifier: MIT
#include "atmosphere/sun/sun_disk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/number/quadrature.h"

namespace alpenglow {
namespace {

constexpr double kRadius_rad = 0.00465;

VisibleDisk AtHeight(double radii) {
  return DiskOverHorizon(std::sin(radii * kRadius_rad), 0.0, kRadius_rad);
}

// Hard case 21.
TEST(SunDisk, HalfOfItIsVisibleWhenItsCentreIsOnTheHorizon) {
  EXPECT_NEAR(AtHeight(0.0).fraction, 0.5, 1e-9);
  // Centroid of a half disk: 4 / (3 pi) radii over the chord.
  EXPECT_NEAR(AtHeight(0.0).mu_s_effective / kRadius_rad, 4.0 / (3.0 * kPi), 1e-5);
}

// Hard case 21.
TEST(SunDisk, SetsSmoothlyFromWholeToNone) {
  double before = 1.0;
  for (double height = 1.0; height >= -1.0; height -= 0.001) {
    const double now = AtHeight(height).fraction;
    EXPECT_LE(now, before);
    EXPECT_LT(before - now, 7e-4)
        << "the widest chord is 2 radii of pi square radii, for a step of 0.001";
    before = now;
  }
  EXPECT_EQ(AtHeight(1.5).fraction, 1.0);
  EXPECT_EQ(AtHeight(-1.5).fraction, 0.0);
}

// Hard case 21.
TEST(SunDisk, VisiblePartNeverSinksBelowTheHorizon) {
  for (double height = -0.999; height < 1.0; height += 0.01)
    EXPECT_GE(AtHeight(height).mu_s_effective, 0.0) << height;
}

TEST(SunDisk, LimbDarkeningKeepsTheIrradiance) {
  // Mean over the disk: integral of 2 rho f(rho).
  const GaussRule& rule = GaussLegendre(64);
  double mean = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    mean += rule.weight[i] * 2.0 * rule.node[i] * LimbDarkening(rule.node[i]);
  }
  EXPECT_NEAR(mean, 1.0, 1e-5) << "the square root at the limb slows the rule";
  EXPECT_GT(LimbDarkening(0.0), LimbDarkening(0.9));
}

TEST(SunDisk, SolidAngleOfASmallDiskIsItsArea) {
  EXPECT_NEAR(DiskSolidAngle(kRadius_rad) / (kPi * kRadius_rad * kRadius_rad), 1.0, 1e-5)
      << "a^2 / 12";
  EXPECT_NEAR(DiskSolidAngle(kPi), 4.0 * kPi, 1e-12);
}

}  // namespace
}  // namespace alpenglow
