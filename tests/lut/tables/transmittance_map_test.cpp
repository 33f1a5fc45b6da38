// SPDX-License-Identifier: MIT
#include "lut/tables/transmittance_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lut/embedded_text.h"

namespace alpenglow::shared {
namespace {

constexpr double kMapRadius_km = 6371.0;
constexpr double kMapTop_km = 120.0;

// From the ground to the top, dense at both ends.
std::vector<double> MapAltitudes() {
  std::vector<double> altitudes{0.0, 1e-5, 1e-3};
  for (double h = 0.01; h < 0.5 * kMapTop_km; h *= 1.3) {
    altitudes.push_back(h);
    altitudes.push_back(kMapTop_km - h);
  }
  return altitudes;
}

// Every direction that misses the ground, dense at the horizon.
std::vector<double> SkyCosines(double h) {
  const double horizon = HorizonCosine<double>(h, kMapRadius_km);
  std::vector<double> cosines{1.0, horizon};
  for (double step = 1e-6; step < 1.0 - horizon; step *= 1.5) cosines.push_back(horizon + step);
  return cosines;
}

TEST(TransmittanceMap, InverseReturnsTheAltitudeOnADenseGrid) {
  for (int i = 0; i <= 10000; ++i) {
    const double h = kMapTop_km * i / 10000.0;
    const double x = UnitFromAltitude<double>(h, kMapTop_km, kMapRadius_km);
    EXPECT_NEAR(AltitudeFromUnit<double>(x, kMapTop_km, kMapRadius_km), h, 1e-12 * kMapTop_km)
        << "a square root and its square: a few rounding errors";
  }
}

TEST(TransmittanceMap, InverseReturnsTheRayOnADenseGrid) {
  for (const double h : MapAltitudes()) {
    for (const double mu : SkyCosines(h)) {
      const double x = UnitFromSkyCosine<double>(h, mu, kMapTop_km, kMapRadius_km);
      ASSERT_GE(x, 0.0);
      ASSERT_LE(x, 1.0);
      const double back = SkyCosineFromUnit<double>(x, h, kMapTop_km, kMapRadius_km);
      // Upwards from just below the top, distances hardly depend on direction: the map forgets it.
      const double d = DistanceUpTo<double>(h, mu, kMapTop_km, kMapRadius_km);
      const double distance_per_cosine =
          d * (kMapRadius_km + h) / ((kMapRadius_km + h) * std::abs(mu) + d);
      EXPECT_NEAR(back, mu, 1e-12 + 1e-15 * 4.0 * kMapRadius_km / distance_per_cosine)
          << "altitude " << h << " km";
    }
  }
}

// Hard case 37.
TEST(TransmittanceMap, ForwardReturnsTheCoordinateOfEveryTexelCentre) {
  for (const double n : {2.0, 3.0, 64.0, 256.0}) {
    for (double i = 0.0; i < n; ++i) {
      const double u = (i + 0.5) / n;
      const double x = UnitFromTexel<double>(u, n);
      EXPECT_NEAR(TexelFromUnit<double>(x, n), u, 1e-15);
      const double h = AltitudeFromUnit<double>(x, kMapTop_km, kMapRadius_km);
      EXPECT_NEAR(UnitFromAltitude<double>(h, kMapTop_km, kMapRadius_km), x, 1e-13);
      for (const double z : {0.0, 0.01, 1.0, 10.0, 119.0}) {
        const double mu = SkyCosineFromUnit<double>(x, z, kMapTop_km, kMapRadius_km);
        EXPECT_NEAR(UnitFromSkyCosine<double>(z, mu, kMapTop_km, kMapRadius_km), x, 1e-12) << z;
      }
    }
  }
}

// Hard case 37.
TEST(TransmittanceMap, FirstAndLastTexelCentresAreTheEndsOfTheRange) {
  EXPECT_DOUBLE_EQ(TexelFromUnit<double>(0.0, 256.0), 0.5 / 256.0);
  EXPECT_DOUBLE_EQ(TexelFromUnit<double>(1.0, 256.0), 255.5 / 256.0);
  EXPECT_EQ(UnitFromAltitude<double>(0.0, kMapTop_km, kMapRadius_km), 0.0);
  EXPECT_EQ(UnitFromAltitude<double>(kMapTop_km, kMapTop_km, kMapRadius_km), 1.0);
  EXPECT_EQ(UnitFromSkyCosine<double>(1.0, 1.0, kMapTop_km, kMapRadius_km), 0.0);
  const double horizon = HorizonCosine<double>(1.0, kMapRadius_km);
  EXPECT_NEAR(UnitFromSkyCosine<double>(1.0, horizon, kMapTop_km, kMapRadius_km), 1.0, 1e-13);
}

// Hard case 9.
TEST(TransmittanceMap, FloatAgreesWithDouble) {
  for (const double z : MapAltitudes()) {
    const float h = static_cast<float>(z);
    const double x = UnitFromAltitude<double>(double{h}, kMapTop_km, kMapRadius_km);
    EXPECT_NEAR(UnitFromAltitude<float>(h, 120.0F, 6371.0F), x, 1e-5 * x + 1e-12) << z;
    for (const double cosine : SkyCosines(z)) {
      const float mu = static_cast<float>(cosine);
      EXPECT_NEAR(UnitFromSkyCosine<float>(h, mu, 120.0F, 6371.0F),
                  UnitFromSkyCosine<double>(double{h}, double{mu}, kMapTop_km, kMapRadius_km), 1e-5)
          << z << " km, " << cosine;
    }
    for (float u = 0.0F; u <= 1.0F; u += 0.01F) {
      EXPECT_NEAR(SkyCosineFromUnit<float>(u, h, 120.0F, 6371.0F),
                  SkyCosineFromUnit<double>(double{u}, double{h}, kMapTop_km, kMapRadius_km), 1e-5)
          << z << " km, " << u;
    }
  }
}

// Hard case 9.
TEST(TransmittanceMap, AltitudesOfMillimetresSurviveSinglePrecision) {
  for (const double h : {1e-6, 1e-3, 1.0}) {
    const float x = UnitFromAltitude<float>(static_cast<float>(h), 120.0F, 6371.0F);
    EXPECT_NEAR(AltitudeFromUnit<float>(x, 120.0F, 6371.0F), h, 1e-6 * h)
        << "rho^2 / (R + r) does not cancel; sqrt(r^2 - R^2) would be 0";
  }
}

TEST(TransmittanceMap, TextIsEmbeddedForShaders) {
  const std::string_view text = lut::EmbeddedText("lut/tables/transmittance_map.glsl");
  EXPECT_NE(text.find("UnitFromSkyCosine"), std::string_view::npos);
}

}  // namespace
}  // namespace alpenglow::shared
