// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_physics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "renderer/clouds/portable_functions.h"

namespace alpenglow::renderer {
namespace {

TEST(PortableFunctions, AgreeWithThoseOfTheLibrary) {
  for (int i = -400; i <= 400; ++i) {
    const double x = 0.173 * i;
    EXPECT_NEAR(PortableExp2(x) / std::exp2(x), 1.0, 1e-9) << x;
    EXPECT_NEAR(PortableLog2(std::exp2(x)), x, 1e-9) << x;
    const double angle = 2.0 * std::numbers::pi * x;
    EXPECT_NEAR(PortableCircle(x).x, std::cos(angle), 1e-9) << x;
    EXPECT_NEAR(PortableCircle(x).y, std::sin(angle), 1e-9) << x;
  }
  for (const double y : {-1.7, -0.5, 1.0 / 3.0, 2.5}) {
    // |y log2 x| is below 10.
    for (const double x : {0.07, 0.5, 1.0, 3.7, 15.0}) {
      EXPECT_NEAR(PortablePower(x, y) / std::pow(x, y), 1.0, 1e-8) << x << "^" << y;
    }
  }
}

TEST(CloudPhysics, StandardAirIsThatOfTheTable) {
  // ISO 2533 at 2000 m: 275.15 K, 79501 Pa; its geopotential differs by 0.03 %.
  const BaseAir air = StandardBaseAir(2000.0);
  EXPECT_NEAR(air.temperature_K, 275.15, 0.01);
  EXPECT_NEAR(air.pressure_Pa, 79501.0, 30.0);
}

TEST(CloudPhysics, WarmAirCondensesTwoGramsPerKilometre) {
  // Albrecht et al. (1990) and later work: 1.9 to 2.3 g m^-3 km^-1 for low clouds at 280 to 285 K.
  const double rate = CondensationRate_kg_per_m4({283.0, 88000.0});
  EXPECT_GT(rate, 1.9e-6);
  EXPECT_LT(rate, 2.3e-6);
  EXPECT_LT(CondensationRate_kg_per_m4({250.0, 60000.0}), 0.5 * rate) << "cold air holds little";
}

TEST(CloudPhysics, CondensedWaterKeepsTotalHeat) {
  // Moist static energy c_p T + g z + L r of saturated air is constant on ascent. Its change over
  // 10 m is computed from the rate; the latent heat and the ratio are those of the header.
  const BaseAir air{280.0, 90000.0};
  const double density = air.pressure_Pa / (287.05 * air.temperature_K);
  const double heat = 2.501e6 - 2370.0 * (air.temperature_K - 273.15);
  const double condensed = CondensationRate_kg_per_m4(air) / density;   // per kg and metre
  const double cooling = 9.80665 / 1005.0 - heat * condensed / 1005.0;  // lapse rate
  // The lapse rate of saturated air at 280 K and 900 hPa is 5.3 K/km in tables (Smithsonian
  // Meteorological Tables, table 79), which are rounded to 0.1.
  EXPECT_NEAR(1e3 * cooling, 5.3, 0.15);
}

TEST(CloudPhysics, DropletsHoldTheWater) {
  // N droplets per volume with volume radius r_v hold N 4/3 pi r_v^3 rho; r_v^3 = k r_eff^3.
  const double water = 4e-4, number = 1.5e8, k = 0.8;
  const double radius = 1e-6 * DropletRadius_um(water, number, k);
  EXPECT_NEAR(number * 4.0 / 3.0 * std::numbers::pi * k * std::pow(radius, 3) * 1000.0, water,
              1e-12 * water)
      << "only rounding";
}

TEST(CloudPhysics, ExtinctionIsTwiceTheCrossSection) {
  // Equal spheres have k = 1, so their extinction is 2 N pi r^2.
  const double water = 3e-4, number = 1e8;
  const double radius_um = DropletRadius_um(water, number, 1.0);
  const double expected = 2.0 * number * std::numbers::pi * std::pow(1e-6 * radius_um, 2);
  EXPECT_NEAR(WaterExtinction_per_m(water, radius_um), expected, 1e-12 * expected);
  EXPECT_NEAR(IceExtinction_per_m(0.917 * water, radius_um), expected, 1e-12 * expected)
      << "ice of the same volume";
  EXPECT_EQ(WaterExtinction_per_m(0.0, radius_um), 0.0);
}

TEST(CloudPhysics, RadiusGrowsAsTheCubeRootOfHeight) {
  const DropletOptions options{1000.0, 2e-6, 0.7, 200.0, 0.8};
  const CloudLevel low = DropletLevel(options, 1100.0), high = DropletLevel(options, 1800.0);
  EXPECT_NEAR(high.effective_radius_um / low.effective_radius_um, 2.0, 1e-12);
  EXPECT_NEAR(high.extinction_per_m / low.extinction_per_m, 4.0, 1e-12);
  EXPECT_EQ(DropletLevel(options, 999.0).extinction_per_m, 0.0);
}

TEST(CloudPhysics, MoreDropletsOfTheSameWaterScatterMore) {
  DropletOptions options{1000.0, 2e-6, 0.7, 50.0, 0.8};
  const double few = DropletLevel(options, 1500.0).extinction_per_m;
  options.number_per_cm3 = 400.0;
  EXPECT_NEAR(DropletLevel(options, 1500.0).extinction_per_m / few, 2.0, 1e-12) << "N^(1/3)";
}

TEST(CloudPhysics, ColumnAgreesWithItsFormula) {
  const DropletOptions options{1000.0, 2e-6, 0.7, 200.0, 0.8};
  const CloudColumn column = DropletColumn(options, 3000.0);
  for (double z = 1030.0; z < 3000.0; z += 1.7) {
    const CloudLevel level = DropletLevel(options, z);
    // The bound of the header, from the second derivative of h^(2/3).
    EXPECT_NEAR(column.Extinction_per_m(z), level.extinction_per_m, 1e-3 * level.extinction_per_m);
    EXPECT_NEAR(column.EffectiveRadius_um(z), level.effective_radius_um,
                1e-3 * level.effective_radius_um);
    EXPECT_NEAR(column.Water_kg_per_m3(z), level.water_kg_per_m3, 1e-9) << "linear";
  }
  EXPECT_EQ(column.Extinction_per_m(900.0), 0.0);
}

TEST(CloudPhysics, LargestExtinctionIsReached) {
  const DropletOptions options{1000.0, 2e-6, 0.7, 200.0, 0.8};
  const CloudColumn column = DropletColumn(options, 3000.0);
  EXPECT_EQ(column.LargestBetween_per_m(1203.0, 1207.0), column.Extinction_per_m(1207.0));
  EXPECT_EQ(column.LargestBetween_per_m(800.0, 900.0), 0.0);
  EXPECT_EQ(IceColumn(1e-5, 30.0).LargestBetween_per_m(0.0, 9000.0),
            IceExtinction_per_m(1e-5, 30.0));
}

}  // namespace
}  // namespace alpenglow::renderer
