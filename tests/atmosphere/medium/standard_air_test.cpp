// SPDX-License-Identifier: MIT
#include "atmosphere/medium/standard_air.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alpenglow::atmosphere {
namespace {

// U.S. Standard Atmosphere 1976, table I: geometric height [m], density [kg/m3].
TEST(StandardAir, DensityAgreesWithThePublishedTable) {
  const double published[][2] = {{0.0, 1.2250},       {1000.0, 1.1117},     {5000.0, 0.73643},
                                 {10000.0, 0.41351},  {15000.0, 0.19476},   {20000.0, 0.088910},
                                 {30000.0, 0.018410}, {50000.0, 1.0269e-3}, {70000.0, 8.2829e-5},
                                 {80000.0, 1.8458e-5}};
  for (const auto& [height_m, density] : published) {
    EXPECT_NEAR(StandardAirAt(height_m).density_kg_per_m3 / density, 1.0, 1e-4)
        << height_m << " m: five digits are printed";
  }
}

// The rows are of the same table: geometric height [m], temperature [K], pressure [Pa].
TEST(StandardAir, TemperatureAndPressureAgreeWithThePublishedTable) {
  const double published[][3] = {{0.0, 288.150, 101325.0},
                                 {5000.0, 255.676, 54048.0},
                                 {10000.0, 223.252, 26500.0},
                                 {20000.0, 216.650, 5529.3}};
  for (const auto& [height_m, temperature_k, pressure_pa] : published) {
    EXPECT_NEAR(StandardAirAt(height_m).temperature_k / temperature_k, 1.0, 1e-4) << height_m;
    EXPECT_NEAR(StandardAirAt(height_m).pressure_pa / pressure_pa, 1.0, 1e-4) << height_m;
  }
}

TEST(StandardAir, SpeedOfSoundAgreesWithPublishedValues) {
  EXPECT_NEAR(StandardAirAt(0.0).sound_m_per_s, 340.294, 0.01) << "as the standard prints it";
  EXPECT_NEAR(StandardAirAt(15000.0).sound_m_per_s, 295.07, 0.01);
}

TEST(StandardAir, DensityFallsContinuouslyUpToOrbit) {
  double below = StandardAirAt(-500.0).density_kg_per_m3;
  for (double h = -400.0; h < 400e3; h += 100.0) {
    const double here = StandardAirAt(h).density_kg_per_m3;
    ASSERT_LT(here, below) << h;
    ASSERT_GT(here, below * std::exp(-100.0 / 4000.0)) << h << ": no scale height is below 4 km";
    below = here;
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
