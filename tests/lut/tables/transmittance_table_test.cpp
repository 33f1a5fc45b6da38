// SPDX-License-Identifier: MIT
#include "lut/tables/transmittance_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "atmosphere/base/error.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"
#include "tests/lut/tables/table_errors.h"

namespace alpenglow::lut {
namespace {

double ReferenceTransmittance(const Medium& medium, const ViewRay& ray, std::size_t band) {
  return std::exp(-reference::OpticalDepthAlong(medium, ray).tau[band]);
}

bool HitsGround(const Medium& medium, const ViewRay& ray) {
  return ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m).end == RayEnd::kGround;
}

TEST(TransmittanceTable, TexelsAreTheTransmittanceOfTheirRays) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium, {.mu = 9, .altitudes = 7});
  const std::size_t bands = medium.wavelengths_nm.size();
  for (std::size_t row = 0; row < 7; ++row) {
    for (std::size_t column = 0; column < 9; ++column) {
      const auto point = table.PointOfTexel(column, row);
      // The reference solution calls grazing rays blocked by its own rounding: it gets a nudge up.
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

TEST(TransmittanceTable, ErrorAgainstTheReferenceIsBelowTheStatedBound) {
  for (const char* preset : {"earth", "bruneton2017"}) {
    const Medium medium = MediumPreset(preset);
    const TransmittanceTable table(medium);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    ErrorStatistics errors;
    for (int i = 0; i < 1500; ++i) {
      const double u = uniform(random);
      const double h = (i % 2 == 0 ? 3000.0 : medium.atmosphere_height_m) * u * u;
      const double horizon =
          -std::sqrt(h * (2.0 * medium.planet_radius_m + h)) / (medium.planet_radius_m + h);
      const double v = uniform(random);  // dense at the horizon
      const ViewRay ray{h, horizon + (1.0 - horizon) * v * v + 1e-9, 1.0, 1.0};
      const Bands<float> looked_up = table.Lookup(ray.altitude_m, ray.mu);
      for (std::size_t band = 0; band < looked_up.count; ++band) {
        errors.Add(looked_up[band], ReferenceTransmittance(medium, ray, band));
      }
    }
    EXPECT_LT(errors.Max(), 4e-3) << preset << ": the bound in the header";
    EXPECT_LT(errors.Rms(), 3e-4) << preset << ": the bound in the header";
    RecordProperty(std::string(preset) + "_max", std::to_string(errors.Max()));
    RecordProperty(std::string(preset) + "_rms", std::to_string(errors.Rms()));
  }
}

TEST(TransmittanceTable, SegmentsAreQuotients) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    ViewRay ray = RayFromAngles(20000.0 * uniform(random), 180.0 * uniform(random), 0.0, 0.0);
    ray.length_m = 50000.0 * uniform(random);
    const Bands<float> looked_up = table.LookupAlong(ray);
    for (std::size_t band = 0; band < looked_up.count; ++band) {
      ASSERT_GE(looked_up[band], 0.0F);
      ASSERT_LE(looked_up[band], 1.0F);
      ViewRay beyond = ray;
      beyond.length_m = std::numeric_limits<double>::infinity();
      const double truth = ReferenceTransmittance(medium, ray, band);
      // The way to space in the direction of the quotient: its smallness magnifies the error.
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
TEST(TransmittanceTable, ObserversBelowTheGroundSeeWhatThoseOnItSee) {
  const TransmittanceTable table(MediumPreset("earth"), {.mu = 16, .altitudes = 8});
  EXPECT_EQ(table.Lookup(-430.0, 0.7)[0], table.Lookup(0.0, 0.7)[0]);
  EXPECT_GT(table.Lookup(-11000.0, 0.7)[0], 0.0F);
}

// Hard case 4.
TEST(TransmittanceTable, OnTheTopJustAboveAndJustBelowAgree) {
  const Medium medium = MediumPreset("earth");
  const TransmittanceTable table(medium, {.mu = 64, .altitudes = 32});
  for (const double mu : {-0.15, -0.1, -0.01, 0.3}) {
    const float on = table.Lookup(120000.0, mu)[0];
    EXPECT_NEAR(table.Lookup(120000.0 + 1e-6, mu)[0], on, 1e-5) << mu;
    EXPECT_NEAR(table.Lookup(120000.0 - 1e-6, mu)[0], on, 1e-5) << mu;
  }
}

// Hard case 38.
TEST(TransmittanceTable, TwoTexelsAnAxisWork) {
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
TEST(TransmittanceTable, SizesThatCannotBeAreRefusedWithTheirBytes) {
  const Medium medium = MediumPreset("earth");
  EXPECT_THROW(TransmittanceTable(medium, {.mu = 1, .altitudes = 64}), InputError);
  EXPECT_THROW(TransmittanceTable(medium, {.mu = 256, .altitudes = 0}), InputError);
  try {
    const TransmittanceTable table(medium, {.mu = 60000, .altitudes = 60000});
    FAIL() << "57.6 GB were allowed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("57600000000 bytes"));
  }
  EXPECT_THROW(TransmittanceTable(medium, {.mu = 2, .altitudes = 2}, std::vector<float>(3)),
               InputError);
  EXPECT_THROW(TransmittanceTable(medium, {.mu = 2, .altitudes = 2},
                                  std::vector<float>(4 * medium.wavelengths_nm.size(), NAN)),
               InputError);
}

TEST(TransmittanceTable, MoreBandsThanATableHoldsAreRefused) {
  std::vector<double> wavelengths;
  for (int i = 0; i < 41; ++i) wavelengths.push_back(400.0 + 5.0 * i);
  EXPECT_THROW(TransmittanceTable(MediumPreset("earth", wavelengths)), InputError);
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

TEST(TransmittanceTable, NonsenseIsRefused) {
  const TransmittanceTable table(MediumPreset("earth"), {.mu = 4, .altitudes = 4});
  EXPECT_THROW(static_cast<void>(table.Lookup(NAN, 0.5)), InputError);
  EXPECT_THROW(static_cast<void>(table.Lookup(0.0, NAN)), InputError);
  EXPECT_THROW(static_cast<void>(table.Lookup(-6.4e6, 0.5)), InputError) << "centre of the planet";
}

}  // namespace
}  // namespace alpenglow::lut
