// SPDX-License-Identifier: MIT
#include "lut/tables/scattering_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "lut/embedded_text.h"

namespace alpenglow::shared {
namespace {

constexpr double kRadius_km = 6371.0;
constexpr double kTop_km = 120.0;

std::vector<double> Altitudes() {
  std::vector<double> altitudes{1e-5, 1e-3};
  for (double h = 0.01; h < kTop_km; h *= 1.3) altitudes.push_back(h);
  altitudes.push_back(kTop_km);
  return altitudes;
}

// Every direction that meets the ground, dense at the horizon.
std::vector<double> GroundCosines(double h) {
  const double horizon = HorizonCosine<double>(h, kRadius_km);
  std::vector<double> cosines{-1.0};
  for (double step = 1e-6; step < 1.0 + horizon; step *= 1.5) cosines.push_back(horizon - step);
  return cosines;
}

TEST(ScatteringMap, InverseReturnsTheRayToTheGroundOnADenseGrid) {
  for (const double h : Altitudes()) {
    for (const double mu : GroundCosines(h)) {
      const double x = UnitFromGroundCosine<double>(h, mu, kRadius_km);
      ASSERT_GE(x, 0.0);
      ASSERT_LE(x, 1.0);
      EXPECT_NEAR(GroundCosineFromUnit<double>(x, h, kRadius_km), mu, 1e-12) << h << " km";
    }
  }
}

TEST(ScatteringMap, InverseReturnsTheSunOnADenseGrid) {
  for (const double lowest_deg : {102.0, 120.0}) {
    const double lowest = std::cos(lowest_deg * atmosphere::kRadiansPerDegree);
    for (double mu_s = lowest; mu_s <= 1.0; mu_s += 1e-4) {
      const double x = UnitFromSunCosine<double>(mu_s, lowest, kTop_km, kRadius_km);
      ASSERT_GE(x, 0.0);
      ASSERT_LE(x, 1.0);
      EXPECT_NEAR(SunCosineFromUnit<double>(x, lowest, kTop_km, kRadius_km), mu_s, 1e-12);
    }
    EXPECT_NEAR(UnitFromSunCosine<double>(1.0, lowest, kTop_km, kRadius_km), 1.0, 1e-15);
    EXPECT_EQ(UnitFromSunCosine<double>(-1.0, lowest, kTop_km, kRadius_km), 0.0)
        << "suns below the lowest are clamped to it";
  }
}

// Hard case 37.
TEST(ScatteringMap, ForwardReturnsTheCoordinateOfEveryTexelCentre) {
  for (const double n : {4.0, 6.0, 128.0}) {
    for (double i = 0.0; i < n; ++i) {
      const double u = (i + 0.5) / n;
      const double x = UnitFromMuTexel<double>(u, n);
      const double ground = GroundFromMuTexel<double>(u);
      EXPECT_NEAR(MuTexelFromUnit<double>(x, ground, n), u, 1e-15);
      EXPECT_EQ(ground, i < n / 2.0 ? 1.0 : 0.0);
      const double mu = GroundCosineFromUnit<double>(x, 2.0, kRadius_km);
      EXPECT_NEAR(UnitFromGroundCosine<double>(2.0, mu, kRadius_km), x, 1e-12);
    }
  }
  for (double x = 0.0; x <= 1.0; x += 1.0 / 31.0) {
    const double mu_s = SunCosineFromUnit<double>(x, -0.5, kTop_km, kRadius_km);
    EXPECT_NEAR(UnitFromSunCosine<double>(mu_s, -0.5, kTop_km, kRadius_km), x, 1e-12);
    EXPECT_NEAR(UnitFromScatteringCosine<double>(ScatteringCosineFromUnit<double>(x)), x, 1e-15);
  }
}

// Hard case 37.
TEST(ScatteringMap, HalvesMeetAtTheHorizonInTheMiddle) {
  const double n = 128.0;
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(0.0, 1.0, n), 63.5 / 128.0) << "straight down";
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(1.0, 1.0, n), 0.5 / 128.0) << "horizon, seen as ground";
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(0.0, 0.0, n), 64.5 / 128.0) << "straight up";
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(1.0, 0.0, n), 127.5 / 128.0) << "horizon, seen as sky";
}

TEST(ScatteringMap, OnTheGroundEveryDownwardRayHasOneCoordinate) {
  for (const double mu : {-1.0, -0.5, -1e-6, 0.0}) {
    EXPECT_EQ(UnitFromGroundCosine<double>(0.0, mu, kRadius_km), 0.0);
    EXPECT_EQ(UnitFromGroundCosine<float>(0.0F, static_cast<float>(mu), 6371.0F), 0.0F);
  }
  for (const double x : {0.0, 0.5, 1.0}) {
    EXPECT_TRUE(std::isfinite(GroundCosineFromUnit<double>(x, 0.0, kRadius_km)));
  }
}

// Hard case 9.
TEST(ScatteringMap, FloatAgreesWithDouble) {
  for (const double z : Altitudes()) {
    const float h = static_cast<float>(z);
    for (const double cosine : GroundCosines(z)) {
      const float mu = static_cast<float>(cosine);
      if (GroundClearance<double>(double{h}, double{mu}, kRadius_km) <= 0.0) continue;
      // The distance to the ground is a square root at the horizon, of the clearance |r mu| - rho:
      // the four roundings in r, r mu, rho^2 and rho, of 2^-24 each, move the coordinate by this.
      const double clearance = GroundClearance<double>(double{h}, double{mu}, kRadius_km);
      const double rho = HorizonDistance<double>(double{h}, kRadius_km);
      const double rounding = 4.0 * std::ldexp(1.0, -24) * rho;
      const double spread = std::min(1.0, rounding / std::sqrt(2.0 * rho * clearance));
      EXPECT_NEAR(UnitFromGroundCosine<float>(h, mu, 6371.0F),
                  UnitFromGroundCosine<double>(double{h}, double{mu}, kRadius_km), 1e-5 + spread)
          << z << " km, " << cosine;
    }
    for (float u = 0.0F; u <= 1.0F; u += 0.01F) {
      EXPECT_NEAR(GroundCosineFromUnit<float>(u, h, 6371.0F),
                  GroundCosineFromUnit<double>(double{u}, double{h}, kRadius_km), 1e-5);
    }
  }
  for (float mu_s = -0.2F; mu_s <= 1.0F; mu_s += 0.001F) {
    EXPECT_NEAR(UnitFromSunCosine<float>(mu_s, -0.25F, 120.0F, 6371.0F),
                UnitFromSunCosine<double>(double{mu_s}, -0.25, kTop_km, kRadius_km), 1e-5);
  }
  for (float u = 0.0F; u <= 1.0F; u += 0.001F) {
    EXPECT_NEAR(SunCosineFromUnit<float>(u, -0.25F, 120.0F, 6371.0F),
                SunCosineFromUnit<double>(double{u}, -0.25, kTop_km, kRadius_km), 1e-5);
  }
}

// Hard case 13.
TEST(ScatteringMap, ImpossibleScatteringAnglesAreMovedToTheNearestPossible) {
  EXPECT_NEAR(PossibleScatteringCosine<double>(-1.0, 0.3, 1.0), 0.3, 1e-15) << "sun in the zenith";
  EXPECT_NEAR(PossibleScatteringCosine<double>(1.0, 0.6, 0.6), 1.0, 1e-15) << "looking at the sun";
  EXPECT_NEAR(PossibleScatteringCosine<double>(-1.0, 0.6, 0.6), 0.36 - 0.64, 1e-15);
  EXPECT_EQ(PossibleScatteringCosine<double>(0.2, 0.0, 0.0), 0.2);
}

TEST(ScatteringMap, TextIsEmbeddedForShaders) {
  const std::string_view text = lut::EmbeddedText("lut/tables/scattering_map.glsl");
  EXPECT_NE(text.find("UnitFromGroundCosine"), std::string_view::npos);
}

}  // namespace
}  // namespace alpenglow::shared
