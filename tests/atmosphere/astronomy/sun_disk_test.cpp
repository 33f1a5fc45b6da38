// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/sun.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
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

struct MeasuredLimb {
  double wavelength_nm;
  std::array<double, 6> a;  // of mu^k
  double mean;              // of the disk, relative to its centre
};

// Neckel and Labs (1994), Solar Physics 153, 91, table I.
constexpr std::array<MeasuredLimb, 8> kMeasuredLimbs{{
    {390.915, {0.12995, 0.91836, -0.07566, 0.19149, -0.28712, 0.12298}, 0.7204},
    {427.930, {0.14249, 1.28796, -1.19564, 1.68603, -1.36658, 0.44572}, 0.7495},
    {457.345, {0.16604, 1.38544, -1.52275, 2.00232, -1.45969, 0.42864}, 0.7651},
    {519.930, {0.23695, 1.29927, -1.28034, 1.37760, -0.85054, 0.21706}, 0.7925},
    {579.880, {0.28392, 1.36896, -1.75998, 2.22154, -1.56074, 0.44630}, 0.8125},
    {669.400, {0.34685, 1.37539, -2.04425, 2.70493, -1.94290, 0.55999}, 0.8360},
    {811.760, {0.42977, 1.25182, -1.85164, 2.31949, -1.59101, 0.44155}, 0.8621},
    {1046.60, {0.49870, 1.21429, -2.06976, 2.80703, -2.05247, 0.60221}, 0.8841},
}};

TEST(SunDisk, LimbDarkeningOfAWavelengthIsWhatWasMeasured) {
  for (const MeasuredLimb& limb : kMeasuredLimbs) {
    const double centre = LimbDarkening(0.0, limb.wavelength_nm);
    EXPECT_NEAR(1.0 / centre, limb.mean, 0.006) << limb.wavelength_nm;
    for (double mu = 0.1; mu <= 1.0; mu += 0.05) {
      double measured = 0.0;
      for (std::size_t k = 6; k-- > 0;) measured = measured * mu + limb.a.at(k);
      const double rho = std::sqrt(1.0 - std::min(mu * mu, 1.0));
      EXPECT_NEAR(LimbDarkening(rho, limb.wavelength_nm) / centre, measured, 0.011)
          << limb.wavelength_nm << " nm at mu " << mu
          << ": the formula smooths over lines between 390 and 460 nm";
    }
  }
}

TEST(SunDisk, LimbDarkeningKeepsTheIrradianceOfEveryWavelengthAndIsRedderAtTheLimb) {
  const GaussRule& rule = GaussLegendre(64);
  double limb = 0.0;
  for (const double wavelength_nm : {300.0, 372.98, 379.0, 385.0, 422.56, 422.58, 550.0, 1100.0}) {
    double mean = 0.0;
    for (std::size_t i = 0; i < rule.node.size(); ++i)
      mean += rule.weight[i] * 2.0 * rule.node[i] * LimbDarkening(rule.node[i], wavelength_nm);
    EXPECT_NEAR(mean, 1.0, 1e-4) << wavelength_nm << ": the square root at the limb slows the rule";
  }
  for (const double wavelength_nm : {440.0, 550.0, 680.0}) {
    EXPECT_GT(LimbDarkening(0.98, wavelength_nm), limb) << wavelength_nm;
    limb = LimbDarkening(0.98, wavelength_nm);
  }
}

TEST(SunDisk, CirclesOfLightHoldTheirShareOfIt) {
  const GaussRule& rule = GaussLegendre(64);
  for (const double share : {0.0, 0.01, 0.3, 0.5, 0.9, 0.999, 1.0}) {
    const double radius = CircleOfLight(share);
    double light = 0.0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double rho = radius * rule.node[i];
      light += rule.weight[i] * radius * 2.0 * rho * LimbDarkening(rho);
    }
    EXPECT_NEAR(light, share, 1e-5) << "the square root at the limb slows the rule";
  }
}

TEST(SunDisk, SolidAngleOfASmallDiskIsItsArea) {
  EXPECT_NEAR(DiskSolidAngle(kRadius_rad) / (kPi * kRadius_rad * kRadius_rad), 1.0, 1e-5)
      << "a^2 / 12";
  EXPECT_NEAR(DiskSolidAngle(kPi), 4.0 * kPi, 1e-12);
}

}  // namespace
}  // namespace alpenglow::atmosphere
