// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/night_sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

double Radians(double degrees) { return degrees * kRadiansPerDegree; }

TEST(NightSky, AirglowGrowsTowardsTheHorizonAndEndsAboveItsLayer) {
  EXPECT_DOUBLE_EQ(VanRhijn(0.0), 1.0);
  EXPECT_NEAR(VanRhijn(std::sin(Radians(40.0))), 1.29, 0.01) << "a plane layer would have 1.305";
  EXPECT_NEAR(VanRhijn(1.0), 6.04, 0.05) << "at the horizon sqrt(R / 2h) = 5.95, and a little";
  const NightSky sky({}, UtcTime{61212, 0.0});
  const glm::dvec3 up(0.0, 0.0, 1.0);
  EXPECT_GT(sky.Towards(up, up, 80e3).airglow_cd_per_m2, 0.0);
  EXPECT_EQ(sky.Towards(up, up, 400e3).airglow_cd_per_m2, 0.0);
}

TEST(NightSky, ZodiacalLightAgreesWithTheTable) {
  EXPECT_NEAR(ZodiacalLight(Radians(90.0), 0.0), 259e-8, 1e-12);
  EXPECT_NEAR(ZodiacalLight(Radians(-90.0), Radians(-30.0)), 132e-8, 1e-12) << "even both ways";
  EXPECT_NEAR(ZodiacalLight(Radians(1.0), Radians(90.0)), 77e-8, 1e-12);
  const double between = ZodiacalLight(Radians(32.5), Radians(2.5));
  EXPECT_LT(between, 2480e-8);
  EXPECT_GT(between, 1270e-8);
  EXPECT_GT(ZodiacalLight(Radians(180.0), 0.0), ZodiacalLight(Radians(150.0), 0.0))
      << "the gegenschein";
}

TEST(NightSky, MilkyWayIsBrightAtItsCentreAndSplitByDust) {
  const double pole = Starlight(0.0, Radians(90.0));
  EXPECT_GT(pole, 15.0) << "25 to 30 S10 at the poles (Roach, Megill 1961)";
  EXPECT_LT(pole, 40.0);
  EXPECT_GT(Starlight(0.0, Radians(-5.0)), 2.0 * Starlight(Radians(180.0), Radians(-5.0)));
  EXPECT_LT(Starlight(Radians(30.0), Radians(3.0)), Starlight(Radians(30.0), Radians(-4.0)));
  EXPECT_NEAR(Starlight(Radians(179.9999), 0.5), Starlight(Radians(-179.9999), 0.5), 1e-3)
      << "no seam behind";
}

TEST(NightSky, TheCentreOfTheGalaxyCulminatesOnJuneNights) {
  // Sagittarius A* at 17h 45m 40s, -29 degrees, passes the meridian of latitude -30 near the
  // zenith.
  const Place place{.latitude_deg = -29.0};
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const UtcTime noon = ParseInstant("2026-06-21T12:00:00Z");
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

TEST(NightSky, HigherBortleClassesAreBrighter) {
  EXPECT_EQ(ZenithOfBortleClass(1), kNaturalZenith);
  EXPECT_EQ(ZenithOfBortleClass(2), kNaturalZenith);
  for (int higher = 3; higher <= 9; ++higher)
    EXPECT_LT(ZenithOfBortleClass(higher), ZenithOfBortleClass(higher - 1)) << higher;
}

double AngleBetween(const Vector<Ecef>& a, const Vector<Ecef>& b) {
  return std::atan2(glm::length(glm::cross(a.xyz, b.xyz)), glm::dot(a.xyz, b.xyz)) /
         kRadiansPerDegree;
}

/// Returns the declination of date [degrees].
double Declination(const Vector<Ecef>& direction) {
  return std::asin(direction.xyz.z) / kRadiansPerDegree;
}

TEST(Stars, Are5000ToMagnitudeSixBrightestFirst) {
  const auto stars = StarsAt(ParseInstant("2026-01-01T00:00:00Z"));
  EXPECT_EQ(stars.size(), 5080U);
  EXPECT_DOUBLE_EQ(stars.front().magnitude, -1.46) << "Sirius";
  EXPECT_DOUBLE_EQ(stars.back().magnitude, 6.0);
  EXPECT_EQ(StarsAt(ParseInstant("2026-01-01T00:00:00Z"), 1.0).size(), 15U);
}

TEST(Stars, SiriusFollowsProperMotionAndEarthRotation) {
  // The declination of Sirius is -16 42.97' in 2000, with -1.2 arcseconds a year of proper motion
  // and -3.9 by precession, 20.04 times the cosine of the right ascension.
  const auto then = StarsAt(ParseInstant("2000-01-01T12:00:00Z")).front();
  const auto now = StarsAt(ParseInstant("2050-01-01T12:00:00Z")).front();
  EXPECT_NEAR(Declination(then.direction), -16.7161, 0.005) << "nutation: 9 arcseconds";
  EXPECT_NEAR(Declination(now.direction), -16.7161 - 50.0 * 5.13 / 3600.0, 0.005);
}

TEST(Stars, TheBeltOfOrionPointsAtSirius) {
  const auto stars = StarsAt(ParseInstant("2026-01-15T21:00:00Z"));
  const auto near = [&](double magnitude, double colour) {
    for (const PointLight& star : stars) {
      if (star.magnitude == magnitude && star.colour_index == colour) return star.direction;
    }
    return Vector<Ecef>{};
  };
  const auto betelgeuse = near(0.50, 1.85), rigel = near(0.12, -0.03);
  EXPECT_NEAR(AngleBetween(betelgeuse, rigel), 18.6, 0.1);
  EXPECT_NEAR(AngleBetween(betelgeuse, stars.front().direction), 27.1, 0.1);
}

TEST(Stars, LightAndColourFollowFromMagnitudes) {
  EXPECT_NEAR(IlluminanceOf(-1.46), 9.7e-6, 0.1e-6);
  EXPECT_DOUBLE_EQ(MagnitudeOf(IlluminanceOf(3.5)), 3.5);
  EXPECT_NEAR(TemperatureOf(0.65), 5770.0, 60.0) << "the sun";
  EXPECT_NEAR(TemperatureOf(0.0), 10100.0, 300.0) << "Vega, a black body of 9,600 to 10,100 K";
}

TEST(Planets, LieOnTheEclipticWithMagnitudesOfAlmanacs) {
  const Place place = PlaceFromRadians(0.8, 0.0, 0.0);
  // Jupiter is in opposition on 2026 January 10 in Gemini, V = -2.7; Saturn has V = 1.2 in Pisces.
  const auto planets = PlanetsAt(place, ParseInstant("2026-01-10T00:00:00Z"));
  const Vector<Ecef> to_sun =
      EcefTowards(TrueSunAt(place, ParseInstant("2026-01-10T00:00:00Z")), place);
  EXPECT_NEAR(AngleBetween(planets[3].direction, to_sun), 180.0, 1.0);
  EXPECT_NEAR(planets[3].magnitude, -2.7, 0.15);
  EXPECT_NEAR(planets[4].magnitude, 1.1, 0.3);
  EXPECT_LT(AngleBetween(planets[1].direction, to_sun), 3.0) << "Venus behind the sun";
  // The greatest elongation east, on 2026 August 15, is 45.9 degrees.
  const auto evening = PlanetsAt(place, ParseInstant("2026-08-15T06:00:00Z"));
  const Vector<Ecef> to_late =
      EcefTowards(TrueSunAt(place, ParseInstant("2026-08-15T06:00:00Z")), place);
  EXPECT_NEAR(AngleBetween(evening[1].direction, to_late), 45.9, 0.2);
  EXPECT_NEAR(evening[1].magnitude, -4.3, 0.2);
}

}  // namespace
}  // namespace alpenglow::atmosphere
