// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/moon.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kArcsecond = kRadiansPerDegree / 3600.0;

/// The centre of the earth, for which almanacs are.
constexpr GeodeticPosition kGeocentre{0.0, 0.0, -6378137.0};

/// The moon at an instant of terrestrial time.
MoonPosition AtTerrestrial(const char* time) { return MoonAt(kGeocentre, ParseInstant(time), 0.0); }

// Meeus, Astronomical Algorithms, 2nd edition, examples 47.a and 48.a: 1992 April 12, 0h TD.
TEST(Moon, ExampleOfMeeus) {
  const MoonPosition moon = AtTerrestrial("1992-04-12T00:00:00Z");
  EXPECT_NEAR(moon.distance_m / 1e3, 368409.7, 20.0) << "of Meeus' selection of terms";
  EXPECT_NEAR(std::asin(moon.direction.xyz.z), 13.768368 * kRadiansPerDegree, 10.0 * kArcsecond)
      << "apparent declination";
  const double sidereal =
      eraGst06a(2400000.5, ParseInstant("1992-04-12T00:00:00Z").modified_julian_day, 2400000.5,
                ParseInstant("1992-04-12T00:00:00Z").modified_julian_day);
  const double ascension = sidereal + std::atan2(moon.direction.xyz.y, moon.direction.xyz.x);
  EXPECT_NEAR(std::remainder(ascension - 134.688470 * kRadiansPerDegree, 2.0 * kPi), 0.0,
              20.0 * kArcsecond)
      << "apparent right ascension";
  EXPECT_NEAR(moon.phase_angle_rad / kRadiansPerDegree, 69.0756, 0.01);
  EXPECT_NEAR(moon.IlluminatedFraction(), 0.6786, 2e-4);
  EXPECT_NEAR(moon.bright_limb_rad / kRadiansPerDegree, 285.0, 0.1);
  EXPECT_NEAR(moon.angular_radius_rad, 0.272481 * 6378137.0 / moon.distance_m, 3e-6)
      << "Meeus' radius, in equatorial radii of the earth, is that of the mountains: 0.03 % more";
}

// Lunations: the phases of the almanacs, to the minute they are given to.
TEST(Moon, IsFullAndNewWhenAlmanacsSay) {
  // Total lunar eclipse of 2000 January 21, greatest at 4:43:28 UT (Espenak, NASA).
  const MoonPosition eclipsed = MoonAt(kGeocentre, ParseInstant("2000-01-21T04:43:28Z"));
  EXPECT_LT(eclipsed.phase_angle_rad, 0.5 * kRadiansPerDegree) << "gamma 0.2957 earth radii";
  EXPECT_GT(eclipsed.IlluminatedFraction(), 0.9999);
  // Total solar eclipse of 1999 August 11, greatest at 11:03:04 UT at 45.1 N 24.3 E (Espenak, NASA).
  const GeodeticPosition place = PlaceFromDegrees(45.0667, 24.2833, 0.0);
  const UtcInstant instant = ParseInstant("1999-08-11T11:03:04Z");
  const MoonPosition moon = MoonAt(place, instant);
  const SunPosition sun = SunAt(place, instant);
  EXPECT_LT(glm::length(moon.direction.xyz - sun.direction.xyz), 25.0 * kArcsecond)
      << "the axis of the shadow passes there within the error of the ephemeris";
  EXPECT_NEAR(moon.angular_radius_rad / sun.angular_radius_rad, 1.0286, 0.004)
      << "the published magnitude";
}

TEST(Moon, StandsLowerOverTheHorizonThanFromTheCentreOfTheEarth) {
  const UtcInstant instant = ParseInstant("2026-06-21T20:00:00Z");
  const MoonPosition centre = MoonAt(kGeocentre, instant);
  // Where the moon stands in the geocentric zenith, and a quarter of the earth away.
  const double longitude = std::atan2(centre.direction.xyz.y, centre.direction.xyz.x);
  const MoonPosition under = MoonAt({std::asin(centre.direction.xyz.z), longitude, 0.0}, instant);
  EXPECT_NEAR(centre.distance_m - under.distance_m, 6371e3, 20e3) << "nearer by the earth's radius";
  const GeodeticPosition aside{0.0, longitude + 0.5 * kPi, 0.0};
  const MoonPosition low = MoonAt(aside, instant);
  const double parallax = 6378137.0 / centre.distance_m;
  EXPECT_NEAR(low.elevation_rad, std::asin(-std::sin(parallax)), 30.0 * kArcsecond)
      << "the horizontal parallax, about a degree";
}

TEST(Moon, RefractionLiftsItAsItLiftsTheSun) {
  const GeodeticPosition place = PlaceFromDegrees(46.5, 8.0, 500.0);
  const UtcInstant instant = ParseInstant("2026-06-21T20:00:00Z");
  const MoonPosition bare = MoonAt(place, instant), seen = ApparentMoonAt(place, instant);
  EXPECT_EQ(seen.elevation_rad,
            bare.elevation_rad + RefractionFromHeight(bare.elevation_rad, 500.0));
  EXPECT_EQ(seen.azimuth_rad, bare.azimuth_rad);
}

TEST(Moon, ItsBrightLimbPointsToTheSun) {
  const GeodeticPosition place = PlaceFromDegrees(46.5, 8.0, 0.0);
  for (const char* utc : {"2026-06-18T19:00:00Z", "2026-06-25T19:00:00Z", "2026-07-07T04:00:00Z"}) {
    const UtcInstant instant = ParseInstant(utc);
    const MoonPosition moon = MoonAt(place, instant);
    const glm::dvec3 sun = SunAt(place, instant).direction.xyz;
    const glm::dvec3 at = moon.direction.xyz;
    const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0.0, 0.0, 1.0), at));
    const glm::dvec3 north = glm::cross(at, east);
    const glm::dvec3 limb =
        std::cos(moon.bright_limb_rad) * north + std::sin(moon.bright_limb_rad) * east;
    const glm::dvec3 across = glm::normalize(glm::cross(at, sun));
    EXPECT_NEAR(glm::dot(limb, across), 0.0, 1e-4) << utc;
    EXPECT_GT(glm::dot(limb, sun), 0.0) << utc;
  }
}

TEST(Moon, RisesAndSetsWhereItsUpperLimbMeetsTheHorizon) {
  const GeodeticPosition place = PlaceFromDegrees(46.5, 8.0, 1200.0);
  UtcInstant instant = ParseInstant("2026-06-01T00:00:00Z");
  const double horizon =
      SeaHorizonFrom(1200.0, OsculatingRadius(kWgs84, place.latitude_rad)).true_elevation_rad;
  double gap_s = 0.0;
  for (int day = 0; day < 5; ++day) {
    const auto rise = NextMoonrise(place, instant);
    ASSERT_TRUE(rise.has_value());
    EXPECT_GT(SecondsBetween(instant, *rise), 0.0);
    const MoonPosition moon = MoonAt(place, *rise);
    EXPECT_NEAR(moon.elevation_rad + moon.angular_radius_rad, horizon, 1e-5) << "0.1 s";
    const auto set = NextMoonset(place, *rise);
    ASSERT_TRUE(set.has_value());
    EXPECT_GT(SecondsBetween(*rise, *set), 6.0 * 3600.0);
    const auto again = NextMoonrise(place, AddSeconds(*rise, 1.0));
    ASSERT_TRUE(again.has_value());
    gap_s += SecondsBetween(*rise, *again) / 5.0;
    instant = *set;
  }
  EXPECT_NEAR(gap_s / 3600.0, 24.84, 0.6) << "the mean lunar day";
}

TEST(Moon, StaysUpOrDownForDaysNearThePole) {
  const GeodeticPosition place = PlaceFromDegrees(85.0, 20.0, 0.0);
  const UtcInstant start = ParseInstant("2026-06-01T00:00:00Z");
  double longest_up_s = 0.0, longest_down_s = 0.0;
  UtcInstant instant = start;
  while (SecondsBetween(start, instant) < 28.0 * 86400.0) {
    const auto rise = NextMoonrise(place, instant);
    ASSERT_TRUE(rise.has_value());
    const auto set = NextMoonset(place, *rise);
    ASSERT_TRUE(set.has_value());
    longest_down_s = std::max(longest_down_s, SecondsBetween(instant, *rise));
    longest_up_s = std::max(longest_up_s, SecondsBetween(*rise, *set));
    instant = *set;
  }
  EXPECT_GT(longest_up_s, 8.0 * 86400.0) << "as long as it stands more than 5 degrees north";
  EXPECT_GT(longest_down_s, 8.0 * 86400.0);
}

}  // namespace
}  // namespace alpenglow::atmosphere
