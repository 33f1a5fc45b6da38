// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/moon.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kArcsecond = kRadiansPerDegree / 3600.0;

/// The centre of the earth, for which almanacs are made.
constexpr Place kGeocentre{0.0, 0.0, -6378137.0};

/// Returns the moon at an instant of terrestrial time.
MoonPosition AtTerrestrial(const char* time) {
  return TrueMoonAt(kGeocentre, ParseInstant(time), 0.0);
}

/// Returns the position angle of the middle of the bright limb: from north over east, [0, 2 pi).
double BrightLimb_rad(const MoonPosition& moon, const Place& place) {
  const glm::dvec3 at = EcefTowards(moon, place).xyz;
  const glm::dvec3 east = glm::cross(glm::dvec3(0.0, 0.0, 1.0), at);
  const glm::dvec3 north = glm::cross(at, east);
  const double angle =
      std::atan2(glm::dot(moon.to_sun.xyz, east), glm::dot(moon.to_sun.xyz, north));
  return angle < 0.0 ? angle + 2.0 * kPi : angle;
}

// Meeus, Astronomical Algorithms, 2nd edition, examples 47.a and 48.a: 1992 April 12, 0h TD.
TEST(Moon, AgreesWithTheExampleOfMeeus) {
  const MoonPosition moon = AtTerrestrial("1992-04-12T00:00:00Z");
  EXPECT_NEAR(moon.distance_m / 1e3, 368409.7, 20.0) << "of Meeus' selection of terms";
  const glm::dvec3 towards = EcefTowards(moon, kGeocentre).xyz;
  EXPECT_NEAR(std::asin(towards.z), 13.768368 * kRadiansPerDegree, 10.0 * kArcsecond)
      << "apparent declination";
  const double day = ParseInstant("1992-04-12T00:00:00Z").modified_julian_day;
  const double sidereal = eraGst06a(2400000.5, day, 2400000.5, day);
  const double ascension = sidereal + std::atan2(towards.y, towards.x);
  EXPECT_NEAR(std::remainder(ascension - 134.688470 * kRadiansPerDegree, 2.0 * kPi), 0.0,
              20.0 * kArcsecond)
      << "apparent right ascension";
  EXPECT_NEAR(moon.phase_angle_deg, 69.0756, 0.01);
  EXPECT_NEAR(moon.illuminated_fraction, 0.6786, 2e-4);
  EXPECT_NEAR(BrightLimb_rad(moon, kGeocentre) / kRadiansPerDegree, 285.0, 0.1);
  EXPECT_NEAR(moon.angular_radius_rad(), 0.272481 * 6378137.0 / moon.distance_m, 3e-6)
      << "Meeus' radius, in equatorial radii of the earth, is that of the mountains: 0.03 % more";
}

// Almanacs give the phases to the minute.
TEST(Moon, IsFullAndNewAtTheTimesOfAlmanacs) {
  // The total lunar eclipse of 2000 January 21 is greatest at 4:43:28 UT (Espenak, NASA).
  const MoonPosition eclipsed = TrueMoonAt(kGeocentre, ParseInstant("2000-01-21T04:43:28Z"));
  EXPECT_LT(eclipsed.phase_angle_deg, 0.5) << "gamma 0.2957 earth radii";
  EXPECT_GT(eclipsed.illuminated_fraction, 0.9999);
  // The total solar eclipse of 1999 August 11 is greatest at 11:03:04 UT at 45.1 N 24.3 E
  // (Espenak).
  const Place place{45.0667, 24.2833, 0.0};
  const UtcTime instant = ParseInstant("1999-08-11T11:03:04Z");
  const MoonPosition moon = TrueMoonAt(place, instant);
  const SunInSky sun = TrueSunAt(place, instant);
  EXPECT_LT(AngleBetween(EcefTowards(moon, place).xyz, EcefTowards(sun, place).xyz),
            25.0 * kArcsecond)
      << "the axis of the shadow passes there within the error of the ephemeris";
  EXPECT_NEAR(moon.angular_radius_rad() / sun.angular_radius_rad(), 1.0286, 0.004)
      << "the published magnitude";
}

TEST(Moon, ParallaxLowersItsElevation) {
  const UtcTime instant = ParseInstant("2026-06-21T20:00:00Z");
  const MoonPosition centre = TrueMoonAt(kGeocentre, instant);
  // One place has the moon in the geocentric zenith, the other is a quarter of the earth away.
  const glm::dvec3 towards = EcefTowards(centre, kGeocentre).xyz;
  const double longitude = std::atan2(towards.y, towards.x);
  const MoonPosition under =
      TrueMoonAt(PlaceFromRadians(std::asin(towards.z), longitude, 0.0), instant);
  EXPECT_NEAR(centre.distance_m - under.distance_m, 6371e3, 20e3) << "nearer by the earth's radius";
  const Place aside = PlaceFromRadians(0.0, longitude + 0.5 * kPi, 0.0);
  const MoonPosition low = TrueMoonAt(aside, instant);
  const double parallax = 6378137.0 / centre.distance_m;
  EXPECT_NEAR(low.elevation_rad(), std::asin(-std::sin(parallax)), 30.0 * kArcsecond)
      << "the horizontal parallax, about a degree";
}

TEST(Moon, RefractionLiftsItLikeTheSun) {
  const Place place{46.5, 8.0, 500.0};
  const UtcTime instant = ParseInstant("2026-06-21T20:00:00Z");
  const MoonPosition bare = TrueMoonAt(place, instant),
                     seen = ApparentMoonAt(place, instant, AlmanacAir());
  EXPECT_EQ(seen.elevation_deg,
            bare.elevation_deg + RefractionFromHeight(AlmanacAir(), bare.elevation_rad(), 500.0) /
                                     kRadiansPerDegree);
  EXPECT_EQ(seen.azimuth_deg, bare.azimuth_deg);
}

TEST(Moon, BrightLimbPointsToTheSun) {
  const Place place{46.5, 8.0, 0.0};
  for (const char* utc : {"2026-06-18T19:00:00Z", "2026-06-25T19:00:00Z", "2026-07-07T04:00:00Z"}) {
    const UtcTime instant = ParseInstant(utc);
    const MoonPosition moon = TrueMoonAt(place, instant);
    const glm::dvec3 sun = EcefTowards(TrueSunAt(place, instant), place).xyz;
    const glm::dvec3 at = EcefTowards(moon, place).xyz;
    const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0.0, 0.0, 1.0), at));
    const glm::dvec3 north = glm::cross(at, east);
    const double limb_rad = BrightLimb_rad(moon, place);
    const glm::dvec3 limb = std::cos(limb_rad) * north + std::sin(limb_rad) * east;
    const glm::dvec3 across = glm::normalize(glm::cross(at, sun));
    EXPECT_NEAR(glm::dot(limb, across), 0.0, 1e-4) << utc;
    EXPECT_GT(glm::dot(limb, sun), 0.0) << utc;
  }
}

TEST(Moon, RisesAndSetsWithItsUpperLimbOnTheHorizon) {
  const Place place{46.5, 8.0, 1200.0};
  UtcTime instant = ParseInstant("2026-06-01T00:00:00Z");
  const double horizon =
      SeaHorizonFrom(1200.0, OsculatingRadius(kWgs84, place.latitude_rad())).true_elevation_rad;
  double gap_s = 0.0;
  for (int day = 0; day < 5; ++day) {
    const UtcTime rise = NextMoonrise(place, instant).value();
    EXPECT_GT(SecondsBetween(instant, rise), 0.0);
    const MoonPosition moon = TrueMoonAt(place, rise);
    EXPECT_NEAR(moon.elevation_rad() + moon.angular_radius_rad(), horizon, 1e-5) << "0.1 s";
    instant = NextMoonset(place, rise).value();
    EXPECT_GT(SecondsBetween(rise, instant), 6.0 * 3600.0);
    gap_s += SecondsBetween(rise, NextMoonrise(place, AddSeconds(rise, 1.0)).value()) / 5.0;
  }
  EXPECT_NEAR(gap_s / 3600.0, 24.84, 0.6) << "the mean lunar day";
}

TEST(Moon, StaysUpOrDownForDaysNearThePole) {
  const Place place{85.0, 20.0, 0.0};
  const UtcTime start = ParseInstant("2026-06-01T00:00:00Z");
  double longest_up_s = 0.0, longest_down_s = 0.0;
  for (UtcTime instant = start; SecondsBetween(start, instant) < 28.0 * 86400.0;) {
    const UtcTime rise = NextMoonrise(place, instant).value();
    const UtcTime set = NextMoonset(place, rise).value();
    longest_down_s = std::max(longest_down_s, SecondsBetween(instant, rise));
    longest_up_s = std::max(longest_up_s, SecondsBetween(rise, set));
    instant = set;
  }
  EXPECT_GT(longest_up_s, 8.0 * 86400.0) << "as long as it stands more than 5 degrees north";
  EXPECT_GT(longest_down_s, 8.0 * 86400.0);
}

double Angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::dvec3 Kilometres(const TerrestrialTime& time) {
  return MoonFromEarth(time).position_au * (kAstronomicalUnit_m / 1e3);
}

struct KnownPlace {
  double julian_day;
  glm::dvec3 position_km;
};

// Another program summed all 35901 terms of ELP/MPP02 with the constants of DE405. It gives the
// positions that Y. T. Liu publishes of the same sum (github.com/ytliu0/ElpMpp02) to 1e-4 km.
constexpr std::array<KnownPlace, 6> kOfAllTerms{{
    {2433392.5, {133664.8, 335981.5, 181498.1}},
    {2442669.5, {59165.0, -364334.3, -131581.7}},
    {2451545.0, {-291608.4, -266716.8, -76102.5}},
    {2461265.25, {-280613.6, 214726.7, 99197.0}},
    {2473533.0, {-324859.5, 198775.3, 123645.7}},
    {2488033.5, {301000.3, 230039.9, 128293.1}},
}};

TEST(MoonOrbit, OmittedTermsMoveItByLessThanAnArcsecond) {
  for (const auto& [day, all_km] : kOfAllTerms) {
    const glm::dvec3 here_km = Kilometres({day, 0.0});
    EXPECT_LT(Angle(here_km, all_km), 0.6 * kArcsecond) << day;
    EXPECT_NEAR(glm::length(here_km), glm::length(all_km), 3.0) << day;
  }
}

// JPL Horizons, DE441: geometric, ICRF, 2022 December 25, 0h TDB.
TEST(MoonOrbit, AgreesWithTheJetPropulsionLaboratory) {
  const glm::dvec3 horizons_au{1.013355885727306e-3, -1.903485709903833e-3, -1.047798412089101e-3};
  const BodyState moon = MoonFromEarth({2459938.5, 0.0});
  EXPECT_LT(Angle(moon.position_au, horizons_au), 0.6 * kArcsecond);
  EXPECT_NEAR(glm::length(moon.position_au), glm::length(horizons_au), 3e3 / kAstronomicalUnit_m);
  const glm::dvec3 velocity{5.762732121285166e-4, 2.476878261262097e-4, 8.902329774047208e-5};
  EXPECT_LT(glm::length(moon.velocity_au_per_day - velocity), 1e-4 * glm::length(velocity))
      << "of which the light time of 1.3 s makes 0.1 m";
}

// ERFA has Meeus' selection of an older theory. Its stated errors are 10 arcseconds in longitude
// and 4 in latitude, rms, and 20 km or so of distance.
TEST(MoonOrbit, AgreesWithErfaWithinTwentyArcseconds) {
  double square = 0.0;
  constexpr int kDays = 2000;
  for (int i = 0; i < kDays; ++i) {
    const double day = 2433282.5 + i * 27.4;  // 1950 to 2100
    double pv[2][3];
    eraMoon98(day, 0.0, pv);
    const glm::dvec3 erfa(pv[0][0], pv[0][1], pv[0][2]);
    const glm::dvec3 here = MoonFromEarth({day, 0.0}).position_au;
    const double angle = Angle(here, erfa);
    EXPECT_LT(angle, 20.0 * kArcsecond) << day;
    square += angle * angle / kDays;
  }
  EXPECT_LT(std::sqrt(square), 6.0 * kArcsecond);
}

TEST(MoonOrbit, SplitDatesGiveTheSamePosition) {
  EXPECT_LT(glm::length(Kilometres({2461265.0, 0.25}) - Kilometres({2461265.25, 0.0})), 1e-3);
  const BodyState moon = MoonFromEarth({2461265.0, 0.25});
  const glm::dvec3 later = MoonFromEarth({2461265.0, 0.26}).position_au;
  EXPECT_LT(Angle(later - moon.position_au, moon.velocity_au_per_day), 0.01);
}

MoonPosition PositionAtPhase(double phase_angle_rad, double sun_distance_au = 1.0) {
  MoonPosition moon{};
  moon.angular_radius_deg = 0.0045 / kRadiansPerDegree;
  moon.phase_angle_deg = phase_angle_rad / kRadiansPerDegree;
  moon.sun_distance_au = sun_distance_au;
  moon.distance_m = 384.4e6;
  return moon;
}

/// Returns the disk of a moon in the east.
MoonDisk DiskOf(const MoonPosition& moon) {
  const double a = moon.phase_angle_rad();
  return MoonDiskOf(moon, Unrefracted({1.0, 0.0, 0.0}), {-std::cos(a), 0.0, std::sin(a)}, 1.0);
}

MoonDisk AtPhase(double degrees) { return DiskOf(PositionAtPhase(degrees * kRadiansPerDegree)); }

/// Returns a direction some radii beside the disk's centre, to the left and up.
glm::dvec3 Beside(double left, double up) {
  return glm::normalize(glm::dvec3(1.0, 0.0045 * left, 0.0045 * up));
}

/// Returns the irradiance of the disk, per unit of the sun's.
double Light(const MoonDisk& moon) {
  constexpr int kSide = 400;
  constexpr double kStep = 2.0 / kSide;
  double sum = 0.0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j)
      sum += MoonRadiance(moon, Beside((i + 0.5) * kStep - 1.0, (j + 0.5) * kStep - 1.0));
  }
  return sum * kStep * kStep * 0.0045 * 0.0045;
}

TEST(MoonDisk, FullMoonGivesAThirdOfALux) {
  const double lux = 133e3 * Light(AtPhase(5.0));  // of the sun outside the air: 133,000 lux
  EXPECT_NEAR(lux, 0.32 * std::pow(10.0, -0.4 * 0.13), 0.02)
      << "V = -12.73 + 0.026 a, where 1 lux is -13.98 (Allen)";
}

TEST(MoonDisk, LightFallsWithPhaseAsMeasured) {
  for (const double degrees : {7.0, 10.0, 30.0, 45.0, 90.0, 120.0, 145.0}) {
    const double magnitudes = 3.84 + 0.026 * degrees + 4e-9 * std::pow(degrees, 4.0);
    const double lux = 10.764 * std::pow(10.0, -0.4 * magnitudes);  // from foot-candles
    EXPECT_NEAR(133e3 * Light(AtPhase(degrees)) / lux, 1.0, 0.12)
        << "Krisciunas and Schaefer (1991), equation 20, who give 0.1 magnitudes; " << degrees;
  }
  EXPECT_NEAR(Light(AtPhase(90.0)) / Light(AtPhase(3.0)), 0.088, 0.01) << "a tenth, at half moon";
}

TEST(MoonDisk, BrightensStronglyAtOpposition) {
  const double steady = Light(AtPhase(10.0)) * std::pow(10.0, 0.4 * 0.026 * 8.5);
  EXPECT_GT(Light(AtPhase(1.5)) / steady, 1.1);
  EXPECT_LT(Light(AtPhase(1.5)) / steady, 1.35)
      << "up to 35 %: Krisciunas and Schaefer (1991), section 3";
}

TEST(MoonDisk, IrradianceIsTheIntegralOfItsRadiance) {
  const MoonPosition moon = PositionAtPhase(1.0, 1.01);
  EXPECT_NEAR(Light(DiskOf(moon)) / MoonIrradiance(moon, 1.0, 550.0), 1.0, 0.005)
      << "the sum over the disk is coarse, and earthshine is not in the light: 0.0003";
}

TEST(MoonDisk, LightIsRedderThanSunlight) {
  const MoonPosition moon = PositionAtPhase(0.1);
  EXPECT_NEAR(MoonIrradiance(moon, 1.0, 650.0) / MoonIrradiance(moon, 1.0, 450.0), 1.4, 0.1)
      << "B - V of the moon 0.92, of the sun 0.65 (Allen): 1.28 from 440 to 550 nm";
}

TEST(MoonDisk, EarthLightsTheDarkSideOfACrescent) {
  const MoonDisk crescent = AtPhase(150.0);
  const double luminance = 133e3 * MoonRadiance(crescent, Beside(0.0, 0.0));
  EXPECT_GT(luminance, 0.3) << "12 to 13 magnitudes below full sunlight, 5000 cd/m^2:";
  EXPECT_LT(luminance, 1.0) << "Danjon's ashen light";
  EXPECT_LT(MoonRadiance(AtPhase(20.0), Beside(0.0, 0.9)),
            1.1 * AtPhase(20.0).radiance_per_irradiance)
      << "gone by full moon";
}

TEST(MoonDisk, IsLitOnlyOnTheSideOfTheSun) {
  const MoonDisk half = AtPhase(90.0);
  EXPECT_GT(MoonRadiance(half, Beside(0.0, 0.5)), 100.0 * half.earthshine_per_irradiance);
  EXPECT_EQ(MoonRadiance(half, Beside(0.0, -0.5)), half.earthshine_per_irradiance);
  EXPECT_EQ(MoonRadiance(half, Beside(0.3, -0.01)), half.earthshine_per_irradiance);
  EXPECT_GT(MoonRadiance(half, Beside(0.3, 0.02)), 10.0 * half.earthshine_per_irradiance);
  const MoonDisk crescent = AtPhase(150.0);
  EXPECT_EQ(MoonRadiance(crescent, Beside(0.0, 0.8)), crescent.earthshine_per_irradiance);
  EXPECT_GT(MoonRadiance(crescent, Beside(0.0, 0.95)), 10.0 * crescent.earthshine_per_irradiance)
      << "its edge is at cos 30 = 0.87";
}

TEST(MoonDisk, IsDarkBeyondItsLimb) {
  const MoonDisk full = AtPhase(0.0);
  EXPECT_GT(MoonRadiance(full, Beside(0.0, 0.99)), 0.0);
  EXPECT_EQ(MoonRadiance(full, Beside(0.0, 1.01)), 0.0);
  EXPECT_EQ(MoonRadiance(full, -Beside(0.0, 0.0)), 0.0) << "behind the eye";
}

TEST(MoonDisk, NewMoonHasOnlyEarthshine) {
  const double full = Light(AtPhase(0.0));
  EXPECT_NEAR(Light(AtPhase(180.0)) / full, 1.0e-4, 0.1e-4) << "0.37 (6371 / 384400)^2";
  EXPECT_TRUE(std::isfinite(AtPhase(180.0).radiance_per_irradiance));
}

}  // namespace
}  // namespace alpenglow::atmosphere
