// SPDX-License-Identifier: MIT
#include "lut/tables/transmittance_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"
#include "tests/fixtures/fault_of.h"
#include "tests/lut/tables/table_errors.h"

namespace alpenglow::lut {
namespace {

double ReferenceTransmittance(const Medium& medium, const ViewRay& ray, std::size_t band) {
  return std::exp(-reference::OpticalDepthAlong(medium, ray).tau[band]);
}

bool HitsGround(const Medium& medium, const ViewRay& ray) {
  return ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m).end == RayEnd::kGround;
}

TEST(TransmittanceTable, TexelsEqualTheTransmittanceOfTheirRays) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium, {.mu = 9, .altitudes = 7});
  const std::size_t bands = medium.wavelengths_nm.size();
  for (std::size_t row = 0; row < 7; ++row) {
    for (std::size_t column = 0; column < 9; ++column) {
      const auto point = table.PointOfTexel(column, row);
      // Rounding makes the reference solution call grazing rays blocked. A nudge up avoids that.
      const ViewRay ray{point.altitude_m, std::min(point.mu + 1e-12, 1.0), 1.0, 1.0};
      for (std::size_t band = 0; band < bands; ++band) {
        EXPECT_NEAR(table.texels()[(row * 9 + column) * bands + band],
                    ReferenceTransmittance(medium, ray, band), 2e-6)
            << "closed form: 4e-7 of an optical depth of order 1, and one rounding to float";
        if (row + 1 < 7) {
          EXPECT_NEAR(table.Lookup(point.altitude_m, ray.mu)[band],
                      table.texels()[(row * 9 + column) * bands + band], 1e-6)
              << "interpolation is exact at the nodes: row " << row << ", column " << column;
        }
      }
    }
  }
}

TEST(TransmittanceTable, ErrorIsBelowTheStatedBound) {
  for (const char* preset : {"earth", "bruneton2017"}) {
    const Medium medium = MediumPreset(preset);
    const TransmittanceTable table(medium);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    TableErrors errors;
    for (int i = 0; i < 1500; ++i) {
      const double u = uniform(random);
      const double h = (i % 2 == 0 ? 3000.0 : medium.atmosphere_height_m) * u * u;
      const double horizon =
          -std::sqrt(h * (2.0 * medium.planet_radius_m + h)) / (medium.planet_radius_m + h);
      const double v = uniform(random);  // dense at the horizon
      const ViewRay ray{h, horizon + (1.0 - horizon) * v * v + 1e-9, 1.0, 1.0};
      const Spectrum looked_up = table.Lookup(ray.altitude_m, ray.mu);
      for (std::size_t band = 0; band < looked_up.size(); ++band) {
        errors.Add(looked_up[band], ReferenceTransmittance(medium, ray, band));
      }
    }
    EXPECT_LT(errors.Max(), 4e-3) << preset << ": the bound in the header";
    EXPECT_LT(errors.Rms(), 3e-4) << preset << ": the bound in the header";
    RecordProperty(std::string(preset) + "_max", std::to_string(errors.Max()));
    RecordProperty(std::string(preset) + "_rms", std::to_string(errors.Rms()));
  }
}

TEST(TransmittanceTable, SegmentsAreQuotientsOfLookUps) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    ViewRay ray = RayFromAngles(20000.0 * uniform(random), 180.0 * uniform(random), 0.0, 0.0);
    ray.length_m = 50000.0 * uniform(random);
    const Spectrum looked_up = table.LookupAlong(ray);
    for (std::size_t band = 0; band < looked_up.size(); ++band) {
      ASSERT_GE(looked_up[band], 0.0F);
      ASSERT_LE(looked_up[band], 1.0F);
      ViewRay beyond = ray;
      beyond.length_m = std::numeric_limits<double>::infinity();
      const double truth = ReferenceTransmittance(medium, ray, band);
      // A small transmittance to space in the direction of the quotient magnifies the error.
      const bool ground = HitsGround(medium, beyond);
      const double whole =
          ground ? table.LookupAlong(beyond)[band] : table.Lookup(ray.altitude_m, ray.mu)[band];
      EXPECT_NEAR(looked_up[band], truth, 2.0 * 4e-3 * truth / std::max(whole, 0.02)) << i;
    }
  }
}

TEST(TransmittanceTable, GroundIsOpaqueAndEmptySpaceIsClear) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium, {.mu = 16, .altitudes = 8});
  EXPECT_EQ(table.Lookup(1000.0, -0.5)[0], 0.0F);
  EXPECT_EQ(table.Lookup(4e5, -1.0)[0], 0.0F) << "from space, straight down";
  EXPECT_EQ(table.Lookup(4e5, 0.3)[0], 1.0F) << "from space, upwards";
  EXPECT_EQ(table.Lookup(1e8, -0.5)[0], 1.0F) << "from far away, past the limb";
  EXPECT_EQ(table.Lookup(120000.0, 0.5)[0], 1.0F) << "on the top, upwards";
  EXPECT_EQ(table.LookupAlong({100.0, 0.2, 1.0, 1.0, 0.0})[0], 1.0F) << "length 0";
}

// Hard case 2.
TEST(TransmittanceTable, BelowTheGroundEqualsOnTheGround) {
  const TransmittanceTable table(MediumPreset("earth"), {.mu = 16, .altitudes = 8});
  EXPECT_EQ(table.Lookup(-430.0, 0.7)[0], table.Lookup(0.0, 0.7)[0]);
  EXPECT_GT(table.Lookup(-11000.0, 0.7)[0], 0.0F);
}

// Hard case 4.
TEST(TransmittanceTable, IsContinuousAtTheTop) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium, {.mu = 64, .altitudes = 32});
  for (const double mu : {-0.15, -0.1, -0.01, 0.3}) {
    const float on = table.Lookup(120000.0, mu)[0];
    EXPECT_NEAR(table.Lookup(120000.0 + 1e-6, mu)[0], on, 1e-5) << mu;
    EXPECT_NEAR(table.Lookup(120000.0 - 1e-6, mu)[0], on, 1e-5) << mu;
  }
}

// Hard case 38.
TEST(TransmittanceTable, TwoTexelsPerAxisAreEnough) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium, {.mu = 2, .altitudes = 2});
  EXPECT_EQ(table.bytes(), 2U * 2U * medium.wavelengths_nm.size() * sizeof(float));
  for (double zenith = 0.0; zenith <= 180.0; zenith += 3.0) {
    const float value = table.Lookup(500.0, std::cos(zenith * 0.017453292519943295))[0];
    EXPECT_GE(value, 0.0F);
    EXPECT_LE(value, 1.0F);
  }
}

// Hard case 38.
TEST(TransmittanceTable, InvalidTablesAndRaysAreRefused) {
  const Medium medium = MediumPreset("earth");
  EXPECT_THROW(TransmittanceTable(medium, {.mu = 1, .altitudes = 64}), InputError);
  EXPECT_THROW(TransmittanceTable(medium, {.mu = 256, .altitudes = 0}), InputError);
  EXPECT_THAT(
      tests::FaultOf([&] { TransmittanceTable(medium, {.mu = 60000, .altitudes = 60000}); }),
      testing::HasSubstr("57600000000 bytes"));
  const TransmittanceTableSize small{.mu = 2, .altitudes = 2};
  EXPECT_THROW(TransmittanceTable(medium, small, std::vector<float>(3)), InputError);
  const std::vector<float> no_numbers(4 * medium.wavelengths_nm.size(), NAN);
  EXPECT_THROW(TransmittanceTable(medium, small, no_numbers), InputError);
  std::vector<double> wavelengths;
  for (int i = 0; i < 41; ++i) wavelengths.push_back(400.0 + 5.0 * i);
  EXPECT_THROW(TransmittanceTable(MediumPreset("earth", wavelengths)), InputError);
  const TransmittanceTable table(medium, small);
  EXPECT_THROW(static_cast<void>(table.Lookup(NAN, 0.5)), InputError);
  EXPECT_THROW(static_cast<void>(table.Lookup(0.0, NAN)), InputError);
  EXPECT_THROW(static_cast<void>(table.Lookup(-6.4e6, 0.5)), InputError) << "centre of the planet";
}

// Hard case 43.
TEST(TransmittanceTable, NumberOfThreadsDoesNotChangeAByte) {
  const Medium medium = MediumPreset("earth");
  const auto texels_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return TransmittanceTable(medium, {.mu = 64, .altitudes = 32}).texels();
  };
  const std::vector<float> one = texels_with(1);
  EXPECT_EQ(texels_with(2), one);
  EXPECT_EQ(texels_with(8), one);
}

}  // namespace
}  // namespace alpenglow::lut

namespace alpenglow::shared {
namespace {

constexpr double kMapRadius_km = 6371.0;
constexpr double kMapTop_km = 120.0;

// Returns altitudes from the ground to the top, dense at both ends.
std::vector<double> MapAltitudes() {
  std::vector<double> altitudes{0.0, 1e-5, 1e-3};
  for (double h = 0.01; h < 0.5 * kMapTop_km; h *= 1.3) {
    altitudes.push_back(h);
    altitudes.push_back(kMapTop_km - h);
  }
  return altitudes;
}

// Returns directions that miss the ground, dense at the horizon.
std::vector<double> SkyCosines(double h) {
  const double horizon = HorizonCosine<double>(h, kMapRadius_km);
  std::vector<double> cosines{1.0, horizon};
  for (double step = 1e-6; step < 1.0 - horizon; step *= 1.5) cosines.push_back(horizon + step);
  return cosines;
}

TEST(TransmittanceMap, AltitudeIsInvertible) {
  for (int i = 0; i <= 10000; ++i) {
    const double h = kMapTop_km * i / 10000.0;
    const double x = UnitFromAltitude<double>(h, kMapTop_km, kMapRadius_km);
    EXPECT_NEAR(AltitudeFromUnit<double>(x, kMapTop_km, kMapRadius_km), h, 1e-12 * kMapTop_km)
        << "a square root and its square: a few rounding errors";
  }
}

TEST(TransmittanceMap, RaysAreInvertible) {
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
TEST(TransmittanceMap, TexelCentresAreInvertible) {
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
TEST(TransmittanceMap, AltitudesOfMillimetresSurviveFloats) {
  for (const double h : {1e-6, 1e-3, 1.0}) {
    const float x = UnitFromAltitude<float>(static_cast<float>(h), 120.0F, 6371.0F);
    EXPECT_NEAR(AltitudeFromUnit<float>(x, 120.0F, 6371.0F), h, 1e-6 * h)
        << "rho^2 / (R + r) does not cancel; sqrt(r^2 - R^2) would be 0";
  }
}

}  // namespace
}  // namespace alpenglow::shared

namespace alpenglow::lut {
namespace {}  // namespace
}  // namespace alpenglow::lut
