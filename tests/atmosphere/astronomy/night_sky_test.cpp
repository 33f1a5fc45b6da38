// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/night_sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

double Radians(double degrees) { return degrees * kRadiansPerDegree; }

TEST(NightSky, AirglowIsLongerTheLowerOneLooks) {
  EXPECT_DOUBLE_EQ(VanRhijn(0.0), 1.0);
  EXPECT_NEAR(VanRhijn(std::sin(Radians(40.0))), 1.29, 0.01) << "a plane layer would have 1.305";
  EXPECT_NEAR(VanRhijn(1.0), 6.04, 0.05) << "at the horizon sqrt(R / 2h) = 5.95, and a little";
}

TEST(NightSky, ZodiacalLightIsThatOfTheTableBetweenItsPointsToo) {
  EXPECT_NEAR(ZodiacalLight(Radians(90.0), 0.0), 259e-8, 1e-12);
  EXPECT_NEAR(ZodiacalLight(Radians(-90.0), Radians(-30.0)), 132e-8, 1e-12) << "even both ways";
  EXPECT_NEAR(ZodiacalLight(Radians(1.0), Radians(90.0)), 77e-8, 1e-12);
  const double between = ZodiacalLight(Radians(32.5), Radians(2.5));
  EXPECT_LT(between, 2480e-8);
  EXPECT_GT(between, 1270e-8);
  EXPECT_GT(ZodiacalLight(Radians(180.0), 0.0), ZodiacalLight(Radians(150.0), 0.0))
      << "the gegenschein";
}

TEST(NightSky, TheMilkyWayIsBrightTowardsItsCentreAndSplitByDust) {
  const double pole = Starlight(0.0, Radians(90.0));
  EXPECT_GT(pole, 15.0) << "25 to 30 S10 at the poles (Roach, Megill 1961)";
  EXPECT_LT(pole, 40.0);
  EXPECT_GT(Starlight(0.0, Radians(-5.0)), 2.0 * Starlight(Radians(180.0), Radians(-5.0)));
  EXPECT_LT(Starlight(Radians(30.0), Radians(3.0)), Starlight(Radians(30.0), Radians(-4.0)));
  EXPECT_NEAR(Starlight(Radians(179.9999), 0.5), Starlight(Radians(-179.9999), 0.5), 1e-3)
      << "no seam behind";
}

TEST(NightSky, TheCentreOfTheGalaxyStandsHighInTheSouthOfAJuneNight) {
  // Sagittarius A* at 17h 45m 40s, -29 degrees, passes the meridian of latitude -30 near the zenith.
  const GeodeticPosition place{.latitude_rad = Radians(-29.0), .longitude_rad = 0.0};
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const UtcInstant noon = ParseInstant("2026-06-21T12:00:00Z");
  double brightest = 0.0;
  int hour_of_brightest = -1;
  for (int hour = 0; hour < 24; ++hour) {
    const NightSky sky(place, AddSeconds(noon, 3600.0 * hour));
    const double starlight = sky.Towards(up, up, 0.0).starlight_cd_per_m2;
    if (starlight > brightest) {
      brightest = starlight;
      hour_of_brightest = hour;
    }
  }
  EXPECT_NEAR(hour_of_brightest, 11.75, 1.5) << "after noon: midnight has 18h of sidereal time";
}

TEST(NightSky, ASkyOfAHigherBortleClassIsBrighter) {
  EXPECT_EQ(ZenithOfBortleClass(1), kNaturalZenith);
  EXPECT_EQ(ZenithOfBortleClass(2), kNaturalZenith);
  for (int higher = 3; higher <= 9; ++higher)
    EXPECT_LT(ZenithOfBortleClass(higher), ZenithOfBortleClass(higher - 1)) << higher;
}

TEST(NightSky, ThereIsNoAirglowAboveItsLayer) {
  const NightSky sky({}, {.modified_julian_day = 61212});
  const glm::dvec3 up(0.0, 0.0, 1.0);
  EXPECT_GT(sky.Towards(up, up, 80e3).airglow_cd_per_m2, 0.0);
  EXPECT_EQ(sky.Towards(up, up, 400e3).airglow_cd_per_m2, 0.0);
}

}  // namespace
}  // namespace alpenglow::atmosphere
