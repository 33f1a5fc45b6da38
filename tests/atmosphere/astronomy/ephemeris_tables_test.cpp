// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/ephemeris_tables.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
namespace {

/// Returns times from 1900 to 2100, and the ends of spans of 16 days.
std::vector<TerrestrialTime> Times() {
  std::vector<TerrestrialTime> times;
  for (int i = 1; i <= 60; ++i) {
    const double day = 15020.0 + 73000.0 * Halton(i, 2);
    times.push_back({2400000.5 + std::floor(day), Halton(i, 3)});
    const double end = 16.0 * std::floor(day / 16.0);
    times.push_back({2400000.5 + end, 0.0});
    times.push_back({2400000.5 + end - 1.0, 1.0 - 1e-9});
  }
  return times;
}

// The bound of the header: 1e-9 au and rad are 150 m and 0.0002 arcseconds.
TEST(EphemerisTables, EarthSunAndAxesAgreeWithErfa) {
  for (const TerrestrialTime& time : Times()) {
    double heliocentric[2][3], barycentric[2][3], axes[3][3];
    eraEpv00(time.day, time.part, heliocentric, barycentric);
    eraPnm06a(time.day, time.part, axes);
    const EarthAndAxes earth = EarthAndAxesAt(time);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(earth.bodies.earth.position_au[i], barycentric[0][i], 1e-9) << time.day;
      EXPECT_NEAR(earth.bodies.earth.velocity_au_per_day[i], barycentric[1][i], 1e-9);
      EXPECT_NEAR(earth.bodies.sun.position_au[i], barycentric[0][i] - heliocentric[0][i], 1e-9);
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(earth.true_from_gcrs[j][i], axes[i][j], 1e-9);
    }
    double x = 0.0, y = 0.0;
    eraBpn2xy(axes, &x, &y);
    EXPECT_NEAR(earth.equation_of_the_origins_rad, eraEors(axes, eraS06(time.day, time.part, x, y)),
                1e-9);
  }
}

TEST(EphemerisTables, TheMoonAgreesWithTheSeriesWithinAMetre) {
  for (const TerrestrialTime& time : Times()) {
    const BodyState table = TabulatedMoonFromEarth(time), series = MoonFromEarth(time);
    EXPECT_LT(glm::distance(table.position_au, series.position_au) * kAstronomicalUnit_m, 1.0)
        << time.day;
    EXPECT_LT(glm::distance(table.velocity_au_per_day, series.velocity_au_per_day) *
                  kAstronomicalUnit_m / kSecondsPerDay,
              1e-3);
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
