// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/sun.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/refraction/refraction.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kSunArcsecond_rad = kRadiansPerDegree / 3600.0;

/// Returns the angle on the sky: near the zenith and at the poles an azimuth alone says little.
double Separation(const Vector<Enu>& a, const Vector<Enu>& b) {
  return std::atan2(glm::length(glm::cross(a.xyz, b.xyz)), glm::dot(a.xyz, b.xyz));
}

Vector<Enu> DirectionTo(const SunInSky& sun) {
  return EnuFromAngles(sun.elevation_rad(), sun.azimuth_rad());
}

/// Returns how far the sun moves between two instants [arcseconds].
double MotionOfSun(const Place& place, const UtcTime& from, const UtcTime& to) {
  return Separation(DirectionTo(TrueSunAt(place, from)), DirectionTo(TrueSunAt(place, to))) /
         kSunArcsecond_rad;
}

// Reda and Andreas (2004), Solar Energy 76, 577-589 (NREL/TP-560-34302), table A5.1.
TEST(Sun, AgreesWithTheExampleOfTheNrelAlgorithm) {
  const SunInSky sun = TrueSunAt(Place{39.742476, -105.1786, 1830.14},
                                 ParseInstant("2003-10-17T12:30:30-07:00"), 67.0);
  const double elevation = sun.elevation_deg;
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, 0.0003) << "SPA's own tolerance";
  // The published zenith angle is 50.11162 with refraction at 820 mbar and 11 C, by equation 42 of
  // SPA.
  const double spa_refraction =
      820.0 / 1010.0 * 283.0 / (273.0 + 11.0) * 1.02 /
      (60.0 * std::tan((elevation + 10.3 / (elevation + 5.11)) * kRadiansPerDegree));
  EXPECT_NEAR(90.0 - elevation - spa_refraction, 50.11162, 0.0003) << "SPA's own tolerance";
  const double ours =
      RefractionFromHeight(AlmanacAir(), sun.elevation_rad(), 1830.14) / kRadiansPerDegree;
  EXPECT_NEAR(ours, spa_refraction, 0.001)
      << "Saemundsson's formula, which SPA uses, is 5 % (0.0008 degrees) high at 40 degrees";
}

struct SpaRow {
  std::string utc;
  double latitude, longitude, height_m, delta_t_s, azimuth, elevation, distance_au;
};

double ErrorInArcseconds(const SpaRow& row) {
  const SunInSky sun = TrueSunAt(CheckedPlace({row.latitude, row.longitude, row.height_m}),
                                 ParseInstant(row.utc), row.delta_t_s);
  EXPECT_NEAR(sun.distance_au, row.distance_au, 6e-5)
      << "theirs is from the centre of the earth, ours from the place: 4.3e-5 au";
  return Separation(DirectionTo(sun), EnuFromAngles(row.elevation * kRadiansPerDegree,
                                                    row.azimuth * kRadiansPerDegree)) /
         kSunArcsecond_rad;
}

// These rows are of an independent implementation of SPA (npm nrel-spa 2.0.2), without refraction.
const std::vector<SpaRow> kSpaRows = {
    {"2044-10-26T09:09:08.951Z", 90, 0, 0, 88.555, 141.312718, -12.717612, 0.994084208},
    {"2060-12-21T17:38:19.864Z", -90, 0, 2835, 115.634, 275.036261, 23.429823, 0.983790414},
    {"2098-03-01T03:33:50.330Z", 0, 180, 0, 198.338, 260.430392, 39.181838, 0.990635940},
    {"1991-05-23T20:31:00.613Z", 0, -180, 0, 57.832, 64.314767, 35.709521, 1.012537505},
    {"2050-11-17T19:50:21.052Z", 66.5633, 25, 0, 94.714, 318.440828, -37.873999, 0.988758555},
    {"1975-08-06T19:32:45.177Z", -66.5633, -60, 0, 46.043, 311.222952, -1.596970, 1.014275701},
    {"2042-05-08T05:27:39.809Z", 22.70289, 115.407009, 3400.2, 86.557, 255.224985, 72.023618,
     1.009138748},
    {"1954-06-24T06:19:43.937Z", -58.612836, -108.964382, 5196.9, 30.826, 202.712466, -53.317862,
     1.016438282},
};

TEST(Sun, AgreesWithSpaWithinTwoArcseconds) {
  for (const SpaRow& row : kSpaRows) EXPECT_LT(ErrorInArcseconds(row), 2.0) << row.utc;
}

TEST(Sun, AgreesWithTheTableOfSpaWithinTwoArcseconds) {
  std::ifstream file(stored::DataFile("tables/sun_nrel_spa.csv"));
  int rows = 0;
  double largest = 0.0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#' || line.rfind("utc", 0) == 0) continue;
    const std::vector<std::string> cells = CellsOf(line);
    ASSERT_EQ(cells.size(), 8U) << line;
    const auto number = [&](std::size_t i) { return std::stod(cells[i]); };
    const double error = ErrorInArcseconds(
        {cells[0], number(1), number(2), number(3), number(4), number(5), number(6), number(7)});
    EXPECT_LT(error, 2.0) << line;
    largest = std::max(largest, error);
    ++rows;
  }
  EXPECT_GT(rows, 200);
  RecordProperty("largest_error_arcseconds", std::to_string(largest));
}

TEST(Sun, DirectionAgreesWithAngles) {
  for (const double latitude : {-90.0, -33.0, 0.0, 46.5, 90.0}) {
    for (int hour = 0; hour < 24; hour += 3) {
      const Place place = CheckedPlace({latitude, 8.0, 500.0});
      const SunInSky sun = TrueSunAt(place, AddSeconds(UtcTime{61041, 0.0}, 3600.0 * hour));
      EXPECT_GE(sun.azimuth_deg, 0.0);
      EXPECT_LT(sun.azimuth_deg, 360.0);
    }
  }
}

TEST(Sun, AzimuthIsMeasuredFromNorthOverEast) {
  EXPECT_LT(Separation(EnuFromAngles(0.0, 0.0), {{0, 1, 0}}), 1e-16);
  EXPECT_LT(Separation(EnuFromAngles(0.0, kPi / 2), {{1, 0, 0}}), 1e-16);
  EXPECT_LT(Separation(EnuFromAngles(kPi / 2, 1.0), {{0, 0, 1}}), 1e-16);
  const auto azimuth_deg = [](const char* utc) {
    return TrueSunAt(Place{47.4, 8.5, 0.0}, ParseInstant(utc)).azimuth_deg;
  };
  EXPECT_NEAR(azimuth_deg("2026-03-20T06:00:00Z"), 90.0, 10.0) << "it rises in the east";
  EXPECT_NEAR(azimuth_deg("2026-03-20T17:00:00Z"), 270.0, 10.0);
}

TEST(Sun, IsLargestAtPerihelion) {
  const Place place{0.0, 0.0, 0.0};
  // Perihelion and aphelion of 2024, USNO: 3 January 01h, 5 July 05h.
  const SunInSky near = TrueSunAt(place, ParseInstant("2024-01-03T01:00:00Z"));
  const SunInSky far = TrueSunAt(place, ParseInstant("2024-07-05T05:00:00Z"));
  EXPECT_NEAR(near.distance_au, 0.98331, 6e-5) << "the place is 4.3e-5 au from the centre";
  EXPECT_NEAR(far.distance_au, 1.01673, 6e-5);
  EXPECT_NEAR(near.angular_radius_rad() * near.distance_au, kSunAngularRadius_rad, 1e-7);
  EXPECT_GT(near.angular_radius_rad(), far.angular_radius_rad());
}

// Hard case 27.
TEST(Sun, AtAPoleOnlyTheAzimuthDependsOnLongitude) {
  const UtcTime instant = ParseInstant("2026-06-21T09:00:00Z");
  for (const double latitude : {-90.0, 90.0}) {
    const SunInSky a = TrueSunAt(CheckedPlace({latitude, 0.0, 0.0}), instant);
    const SunInSky b = TrueSunAt(CheckedPlace({latitude, 120.0, 0.0}), instant);
    EXPECT_NEAR(a.elevation_rad(), b.elevation_rad(), 1e-15);
    EXPECT_NEAR(std::abs(a.elevation_rad()) / kRadiansPerDegree, 23.44, 0.01) << "solstice";
    const double turn = (latitude > 0 ? 1.0 : -1.0) * (b.azimuth_rad() - a.azimuth_rad());
    EXPECT_NEAR(std::remainder(turn - 120.0 * kRadiansPerDegree, 2.0 * kPi), 0.0, 1e-14);
  }
}

// Hard case 27.
TEST(Sun, Longitudes180AndMinus180AreIdentical) {
  for (const double latitude : {-90.0, -16.5, 0.0, 65.0, 90.0}) {
    const UtcTime instant = ParseInstant("2026-02-11T20:17:00Z");
    const SunInSky east = TrueSunAt(CheckedPlace({latitude, 180.0, 10.0}), instant);
    for (const Place& place : {CheckedPlace({latitude, -180.0, 10.0}),
                               PlaceFromRadians(latitude * kRadiansPerDegree, -kPi, 10.0)}) {
      const SunInSky west = TrueSunAt(place, instant);
      EXPECT_EQ(east.elevation_rad(), west.elevation_rad());
      EXPECT_EQ(east.azimuth_rad(), west.azimuth_rad());
      EXPECT_EQ(east.distance_au, west.distance_au);
    }
  }
}

// Hard case 25.
TEST(Sun, MovesEvenlyThroughALeapSecond) {
  const auto moves = [](const char* from, const char* to) {
    return MotionOfSun(Place{-33.9, 151.2, 0.0}, ParseInstant(from), ParseInstant(to));
  };
  const char* last = "2016-12-31T23:59:59Z";
  const char* leap = "2016-12-31T23:59:60Z";
  const char* next = "2017-01-01T00:00:00Z";
  EXPECT_NEAR(moves("2016-12-31T23:59:58Z", last), 13.8, 0.1) << "15 arcseconds * cos 23";
  EXPECT_NEAR(moves(last, leap), 13.8, 0.1);
  EXPECT_LT(moves(leap, next), 0.05)
      << "UT1 = UTC repeats the second; only TT goes on, by 0.04 arcseconds of the orbit";
  EXPECT_NEAR(moves(next, "2017-01-01T00:00:01Z"), 13.8, 0.1);
}

TEST(Sun, MovesSteadilyInYearsThatErfaWarnsOf) {
  const Place place{35.5, 138.8, 900.0};
  for (const char* text : {"1900-01-01T00:00:00Z", "1959-12-31T23:59:59Z", "2026-12-31T23:59:59Z",
                           "2100-12-31T23:59:58Z"}) {
    const UtcTime instant = ParseInstant(text);
    EXPECT_NEAR(MotionOfSun(place, instant, AddSeconds(instant, 1.0)), 13.8, 0.1)
        << text << ": 15 arcseconds * cos 23";
  }
}

TEST(Sun, FollowsTheRotationOfTheEarth) {
  // A second of delta-T moves the ephemeris, not the clock: 0.04 arcseconds, not 15.
  const Place place{10.0, 20.0, 0.0};
  const UtcTime instant = ParseInstant("2026-06-21T12:00:00Z");
  EXPECT_LT(Separation(DirectionTo(TrueSunAt(place, instant, 69.0)),
                       DirectionTo(TrueSunAt(place, instant, 70.0))) /
                kSunArcsecond_rad,
            0.05);
}

TEST(Sun, RisesUntilNoonAndSinksAfterwards) {
  const Place place{46.5, 8.0, 2000.0};
  const UtcTime noon =
      FindSunEvent(SunEvent::kNoon, place, ParseInstant("2026-04-18T12:00:00Z")).value();
  const auto elevation = [&](double time_s) {
    return TrueSunAt(place, AddSeconds(noon, time_s)).elevation_rad();
  };
  for (double time_s = 300.0; time_s <= 11.5 * 3600 - 900.0; time_s += 900.0) {
    EXPECT_GT(elevation(-time_s), elevation(-time_s - 900.0)) << time_s;
    EXPECT_GT(elevation(time_s), elevation(time_s + 900.0)) << time_s;
  }
}

TEST(Sun, BadPlacesAreRefused) {
  EXPECT_THROW((void)TrueSunAt({std::nan(""), 0.0, 0.0}, {}), InputError);
  EXPECT_THROW((void)TrueSunAt({90.1, 0.0, 0.0}, {}), InputError);
}

// --- the disk ---

constexpr double kDiskRadius_rad = 0.00465;

VisibleDisk DiskAtHeight(double radii) {
  return DiskOverHorizon(std::sin(radii * kDiskRadius_rad), 0.0, kDiskRadius_rad);
}

// Hard case 21.
TEST(SunDisk, IsHalfVisibleWithItsCentreOnTheHorizon) {
  EXPECT_NEAR(DiskAtHeight(0.0).fraction, 0.5, 1e-9);
  // The centroid of a half disk is 4 / (3 pi) radii above the chord.
  EXPECT_NEAR(DiskAtHeight(0.0).mu_s_effective / kDiskRadius_rad, 4.0 / (3.0 * kPi), 1e-5);
}

// Hard case 21.
TEST(SunDisk, SetsSmoothly) {
  double before = 1.0;
  for (double height = 1.0; height >= -1.0; height -= 0.001) {
    const double now = DiskAtHeight(height).fraction;
    EXPECT_LE(now, before);
    EXPECT_LT(before - now, 7e-4)
        << "the widest chord is 2 radii of pi square radii, for a step of 0.001";
    before = now;
    EXPECT_GE(DiskAtHeight(height).mu_s_effective, 0.0) << height;
  }
  EXPECT_EQ(DiskAtHeight(1.5).fraction, 1.0);
  EXPECT_EQ(DiskAtHeight(-1.5).fraction, 0.0);
}

/// Returns the light of the disk within a circle, as the integral of 2 rho f(rho). The square root
/// at the limb slows the Gauss rule: 1e-5.
template <typename Darkening>
double LightWithin(double radius, const Darkening& darkening) {
  const GaussRule& rule = GaussLegendre(64);
  double light = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double rho = radius * rule.node[i];
    light += rule.weight[i] * radius * 2.0 * rho * darkening(rho);
  }
  return light;
}

TEST(SunDisk, LimbDarkeningKeepsTheIrradiance) {
  EXPECT_NEAR(LightWithin(1.0, [](double rho) { return LimbDarkening(rho); }), 1.0, 1e-5);
  EXPECT_GT(LimbDarkening(0.0), LimbDarkening(0.9));
  for (const double nm : {300.0, 372.98, 379.0, 385.0, 422.56, 422.58, 550.0, 1100.0}) {
    EXPECT_NEAR(LightWithin(1.0, [nm](double rho) { return LimbDarkening(rho, nm); }), 1.0, 1e-4)
        << nm << ": the square root at the limb slows the rule";
  }
}

TEST(SunDisk, IsRedderAtTheLimb) {
  EXPECT_LT(LimbDarkening(0.98, 440.0), LimbDarkening(0.98, 550.0));
  EXPECT_LT(LimbDarkening(0.98, 550.0), LimbDarkening(0.98, 680.0));
}

TEST(SunDisk, CirclesContainTheirFractionOfTheLight) {
  for (const double share : {0.0, 0.01, 0.3, 0.5, 0.9, 0.999, 1.0}) {
    EXPECT_NEAR(LightWithin(CircleOfLight(share), [](double rho) { return LimbDarkening(rho); }),
                share, 1e-5)
        << "the square root at the limb slows the rule";
  }
}

struct MeasuredLimb {
  double wavelength_nm;
  std::array<double, 6> a;  // of mu^k
  double mean;              // of the disk, relative to its centre
};

// Neckel and Labs (1994), Solar Physics 153, 91, table I.
constexpr std::array<MeasuredLimb, 8> kMeasuredLimbs{{
    {390.915, {0.12995, 0.91836, -0.07566, 0.19149, -0.28712, 0.12298}, 0.7204},
    {427.930, {0.14249, 1.28796, -1.19564, 1.68603, -1.36658, 0.44572}, 0.7495},
    {457.345, {0.16604, 1.38544, -1.52275, 2.00232, -1.45969, 0.42864}, 0.7651},
    {519.930, {0.23695, 1.29927, -1.28034, 1.37760, -0.85054, 0.21706}, 0.7925},
    {579.880, {0.28392, 1.36896, -1.75998, 2.22154, -1.56074, 0.44630}, 0.8125},
    {669.400, {0.34685, 1.37539, -2.04425, 2.70493, -1.94290, 0.55999}, 0.8360},
    {811.760, {0.42977, 1.25182, -1.85164, 2.31949, -1.59101, 0.44155}, 0.8621},
    {1046.60, {0.49870, 1.21429, -2.06976, 2.80703, -2.05247, 0.60221}, 0.8841},
}};

TEST(SunDisk, LimbDarkeningAgreesWithMeasurements) {
  for (const MeasuredLimb& limb : kMeasuredLimbs) {
    const double centre = LimbDarkening(0.0, limb.wavelength_nm);
    EXPECT_NEAR(1.0 / centre, limb.mean, 0.006) << limb.wavelength_nm;
    for (double mu = 0.1; mu <= 1.0; mu += 0.05) {
      double measured = 0.0;
      for (std::size_t k = 6; k-- > 0;) measured = measured * mu + limb.a.at(k);
      const double rho = std::sqrt(1.0 - std::min(mu * mu, 1.0));
      EXPECT_NEAR(LimbDarkening(rho, limb.wavelength_nm) / centre, measured, 0.011)
          << limb.wavelength_nm << " nm at mu " << mu
          << ": the formula smooths over lines between 390 and 460 nm";
    }
  }
}

TEST(SunDisk, SolidAngleOfASmallDiskIsItsArea) {
  EXPECT_NEAR(DiskSolidAngle(kDiskRadius_rad) / (kPi * kDiskRadius_rad * kDiskRadius_rad), 1.0,
              1e-5)
      << "a^2 / 12";
  EXPECT_NEAR(DiskSolidAngle(kPi), 4.0 * kPi, 1e-12);
}

// --- events ---

constexpr std::array kInOrder = {
    SunEvent::kAstronomicalDawn, SunEvent::kNauticalDawn, SunEvent::kCivilDawn,
    SunEvent::kSunrise,          SunEvent::kNoon,         SunEvent::kSunset,
    SunEvent::kCivilDusk,        SunEvent::kNauticalDusk, SunEvent::kAstronomicalDusk};

struct PublishedEvent {
  SunEvent event;
  std::string time;
};

/// Expects events to happen when an almanac says.
void ExpectEvents(const Place& place, const std::vector<PublishedEvent>& published,
                  double tolerance_s, const char* why) {
  for (const auto& [event, time] : published) {
    const UtcTime expected = ParseInstant(time);
    const std::optional<UtcTime> found = FindSunEvent(event, place, expected);
    ASSERT_TRUE(found.has_value()) << time;
    EXPECT_NEAR(SecondsBetween(expected, *found), 0.0, tolerance_s) << time << ": " << why;
  }
}

// United States Naval Observatory, "Sun and Moon data for one day", Atlanta, 6 September 2009, at
// 33.8 N 84.4 W; quoted in the manual of PyEphem, "Rising, Transit, Setting".
TEST(SunEvents, OfAtlantaAgreeWithTheNavalObservatory) {
  ExpectEvents(Place{33.8, -84.4, 0.0},
               {{SunEvent::kCivilDawn, "2009-09-06T06:50:00-04:00"},
                {SunEvent::kSunrise, "2009-09-06T07:15:00-04:00"},
                {SunEvent::kNoon, "2009-09-06T13:36:00-04:00"},
                {SunEvent::kSunset, "2009-09-06T19:56:00-04:00"},
                {SunEvent::kCivilDusk, "2009-09-06T20:21:00-04:00"}},
               34.0, "printed to the minute, plus 4 s for the sun's radius, 16' there");
}

// Skyfield with JPL DE421, its manual, "Almanac Computation"; the sun's radius is 16' there.
TEST(SunEvents, OfBlufftonAgreeWithTheJplEphemeris) {
  const Place bluffton{40.8939, -83.8917, 0.0};
  ExpectEvents(bluffton,
               {{SunEvent::kAstronomicalDawn, "2019-11-08T10:40:19Z"},
                {SunEvent::kNauticalDawn, "2019-11-08T11:12:31Z"},
                {SunEvent::kCivilDawn, "2019-11-08T11:45:18Z"},
                {SunEvent::kCivilDusk, "2019-11-08T22:52:48Z"},
                {SunEvent::kNauticalDusk, "2019-11-08T23:25:34Z"},
                {SunEvent::kAstronomicalDusk, "2019-11-08T23:57:44Z"}},
               1.5, "UT1 - UTC of 0.2 s, and the ephemerides");
  ExpectEvents(
      bluffton,
      {{SunEvent::kSunrise, "2019-11-08T12:14:15Z"}, {SunEvent::kSunset, "2019-11-08T22:23:52Z"}},
      4.0, "16' are 0.3' short of the radius in November: 2 s");
}

TEST(SunEvents, NoonOfTheSpaExampleIsItsTransit) {
  // Reda and Andreas (2004), table A5.1: transit 18:46:04.97 UT.
  ExpectEvents(Place{39.742476, -105.1786, 1830.14}, {{SunEvent::kNoon, "2003-10-17T18:46:04.97Z"}},
               0.5, "their transit is interpolated between days");
}

TEST(SunEvents, FollowEachOtherThroughTheDay) {
  for (const auto& [latitude, longitude] :
       {std::pair{-47.0, -180.0}, {-20.0, 138.0}, {0.0, 0.0}, {20.0, -100.0}, {47.0, 8.0}}) {
    for (const char* day :
         {"2026-03-20T12:00:00Z", "2026-06-21T00:00:00Z", "2026-12-21T23:59:59Z"}) {
      const Place place = CheckedPlace({latitude, longitude, 300.0});
      std::optional<UtcTime> before;
      for (const SunEvent event : kInOrder) {
        const std::optional<UtcTime> found = FindSunEvent(event, place, ParseInstant(day));
        ASSERT_TRUE(found.has_value()) << latitude << " " << longitude << " " << day;
        EXPECT_GT(before ? SecondsBetween(*before, *found) : 1e3, 600.0) << latitude << day;
        before = found;
      }
    }
  }
}

TEST(SunEvents, EveryInstantOfASolarDayFindsTheSameEvents) {
  const Place place{35.36, 138.73, 0.0};  // 9 h 15 min before UTC
  const auto sunrise = [&](const char* around) {
    return FindSunEvent(SunEvent::kSunrise, place, ParseInstant(around)).value();
  };
  const UtcTime first = sunrise("2026-06-21T04:00:00Z");
  EXPECT_EQ(FormatInZone(first, "Asia/Tokyo").substr(0, 13), "2026-06-21T04");
  for (const char* text :
       {"2026-06-20T14:50:00Z", "2026-06-20T18:00:00Z", "2026-06-21T14:40:00Z"}) {
    EXPECT_EQ(sunrise(text), first) << text;
  }
  EXPECT_NEAR(SecondsBetween(first, sunrise("2026-06-21T14:50:00Z")), 86400.0, 60.0)
      << "a day later";
}

TEST(SunEvents, AreFoundWithinATenthOfASecond) {
  for (const double latitude : {0.0, 51.0, 66.0}) {
    const Place place = CheckedPlace({latitude, 25.0, 900.0});
    const double radius_m = OsculatingRadius(kWgs84, place.latitude_rad());
    const double target = SeaHorizonFrom(place.height_m, radius_m).true_elevation_rad;
    const UtcTime found =
        FindSunEvent(SunEvent::kSunrise, place, ParseInstant("2026-03-01T12:00:00Z")).value();
    const auto above = [&](double offset_s) {
      const SunInSky sun = TrueSunAt(place, AddSeconds(found, offset_s));
      return sun.elevation_rad() + sun.angular_radius_rad() - target;
    };
    EXPECT_LT(above(-0.1), 0.0);
    EXPECT_GT(above(0.1), 0.0);
  }
}

TEST(SunEvents, AtSunriseTheUpperLimbIsOnTheSeaHorizon) {
  const Place place{35.36, 138.73, 3776.0};
  const UtcTime sunrise =
      FindSunEvent(SunEvent::kSunrise, place, ParseInstant("2026-01-01T00:00:00Z")).value();
  const SunInSky sun = TrueSunAt(place, sunrise);
  const double limb = sun.elevation_rad() + sun.angular_radius_rad();
  const double radius_m = OsculatingRadius(kWgs84, place.latitude_rad());
  EXPECT_NEAR(limb + RefractionFromHeight(AlmanacAir(radius_m), limb, place.height_m),
              -SeaHorizonFrom(place.height_m, radius_m).dip_rad, 1e-6)
      << "0.01 s of the search are 7e-7";
}

TEST(SunEvents, TheSunRisesEarlierOnASummit) {
  const auto earlier_s = [&](double height) {
    const auto sunrise = [&](double height_m) {
      return FindSunEvent(SunEvent::kSunrise, CheckedPlace({0.0, 0.0, height_m}),
                          ParseInstant("2026-03-20T12:00:00Z"))
          .value();
    };
    return SecondsBetween(sunrise(height), sunrise(0.0));
  };
  EXPECT_NEAR(earlier_s(3776.0), 2.12 * std::sqrt(3776.0) * 4.0, 15.0)
      << "2.12' sqrt(height) and 4 s a minute of arc on the equator; the model differs by 2 %";
  EXPECT_NEAR(earlier_s(-400.0), 0.0, 0.02) << "no dip below the sea; each search is within 0.01 s";
}

bool Happens(SunEvent event, double latitude, double longitude, const char* day) {
  return FindSunEvent(event, CheckedPlace({latitude, longitude, 0.0}), ParseInstant(day))
      .has_value();
}

// Hard case 24.
TEST(SunEvents, PolarDayHasOnlyNoon) {
  for (const SunEvent event : kInOrder)
    EXPECT_EQ(Happens(event, 69.65, 18.96, "2026-06-21T12:00:00Z"), event == SunEvent::kNoon);
}

// Hard case 24.
TEST(SunEvents, PolarNightHasTwilightsDownToItsLowestSun) {
  const auto has = [&](SunEvent event, double latitude) {
    return Happens(event, latitude, 18.0, "2026-12-21T12:00:00Z");
  };
  // At noon the sun stands 23.44 degrees under the equator: at -3.1 in Tromso, -11.7 at 78.2 N.
  for (const double latitude : {69.65, 78.2, 89.0, 90.0}) {
    EXPECT_FALSE(has(SunEvent::kSunrise, latitude));
    EXPECT_FALSE(has(SunEvent::kSunset, latitude));
    EXPECT_TRUE(has(SunEvent::kNoon, latitude));
  }
  EXPECT_TRUE(has(SunEvent::kCivilDawn, 69.65));
  EXPECT_FALSE(has(SunEvent::kCivilDawn, 78.2));
  EXPECT_FALSE(has(SunEvent::kCivilDusk, 78.2));
  EXPECT_TRUE(has(SunEvent::kNauticalDawn, 78.2));
  EXPECT_TRUE(has(SunEvent::kAstronomicalDusk, 78.2));
  EXPECT_FALSE(has(SunEvent::kAstronomicalDawn, 90.0));
}

TEST(SunEvents, WhiteNightsHaveSunriseButNoNauticalDusk) {
  const auto in_petersburg = [](SunEvent event) {
    return Happens(event, 59.94, 30.31, "2026-06-21T09:00:00Z");
  };
  EXPECT_TRUE(in_petersburg(SunEvent::kSunset));
  EXPECT_FALSE(in_petersburg(SunEvent::kNauticalDusk));
  EXPECT_FALSE(in_petersburg(SunEvent::kAstronomicalDawn));
}

// Hard case 27.
TEST(SunEvents, AtThePolesTheSunRisesOnceAYear) {
  for (const double latitude : {-90.0, 90.0}) {
    int sunrises = 0, sunsets = 0;
    for (int day = 0; day < 16; ++day) {  // 12 to 27 March
      const UtcTime around = AddSeconds(ParseInstant("2026-03-12T12:00:00Z"), 86400.0 * day);
      const Place pole = CheckedPlace({latitude, 0.0, 0.0});
      sunrises += FindSunEvent(SunEvent::kSunrise, pole, around).has_value() ? 1 : 0;
      sunsets += FindSunEvent(SunEvent::kSunset, pole, around).has_value() ? 1 : 0;
    }
    EXPECT_EQ(sunrises, latitude > 0.0 ? 1 : 0);
    EXPECT_EQ(sunsets, latitude > 0.0 ? 0 : 1);
  }
}

// Whatever the search samples, it must agree with a watch through the whole day: every minute for
// three hours about midnight, where the sun is near the horizon, and every ten minutes otherwise.
// Hard case 24.
TEST(SunEvents, AreFoundExactlyAroundTheMidnightSun) {
  const Place place{69.65, 0.0, 0.0};
  const double target = SeaHorizonFrom(0.0).true_elevation_rad;
  int days_with = 0;
  constexpr int kDays = 8;
  for (int day = 0; day < kDays; ++day) {
    const UtcTime midnight = AddSeconds(ParseInstant("2026-05-13T00:00:00Z"), 86400.0 * day);
    const auto above = [&](double time_s) {
      const SunInSky sun = TrueSunAt(place, AddSeconds(midnight, time_s));
      return sun.elevation_rad() + sun.angular_radius_rad() > target;
    };
    bool rises = false, sets = false, was_above = above(0.0);
    for (double time_s = 60.0; time_s <= 86400.0;
         time_s += std::abs(time_s - 43200.0) > 37800.0 ? 60.0 : 600.0) {
      const bool is_above = above(time_s);
      rises = rises || (is_above && !was_above);
      sets = sets || (!is_above && was_above);
      was_above = is_above;
    }
    const UtcTime noon = AddSeconds(midnight, 43200.0);
    EXPECT_EQ(FindSunEvent(SunEvent::kSunrise, place, noon).has_value(), rises) << day;
    EXPECT_EQ(FindSunEvent(SunEvent::kSunset, place, noon).has_value(), sets) << day;
    days_with += rises ? 1 : 0;
  }
  EXPECT_GT(days_with, 0);
  EXPECT_LT(days_with, kDays) << "the midnight sun begins within these days";
}

// Hard case 27.
TEST(SunEvents, Longitudes180AndMinus180AreIdentical) {
  const UtcTime around = ParseInstant("2026-06-21T12:00:00Z");
  for (const SunEvent event : kInOrder) {
    const auto east = FindSunEvent(event, Place{-16.5, 180.0, 0.0}, around);
    EXPECT_EQ(east, FindSunEvent(event, CheckedPlace({-16.5, -180.0, 0.0}), around));
    EXPECT_EQ(east, FindSunEvent(event, {-16.5, -180.0, 0.0}, around));
  }
}

TEST(SunEvents, NoonsFollowTheEquationOfTime) {
  const Place place{51.48, 0.0, 0.0};
  double earliest_s = 86400.0, latest_s = 0.0;
  for (int day = 0; day < 365; day += 5) {
    const UtcTime around = AddSeconds(ParseInstant("2026-01-01T12:00:00Z"), 86400.0 * day);
    const UtcTime noon = FindSunEvent(SunEvent::kNoon, place, around).value();
    EXPECT_EQ(noon.modified_julian_day, around.modified_julian_day);
    earliest_s = std::min(earliest_s, noon.second_of_day);
    latest_s = std::max(latest_s, noon.second_of_day);
  }
  EXPECT_NEAR((earliest_s - 43200.0) / 60.0, -16.4, 0.1) << "equation of time in early November";
  EXPECT_NEAR((latest_s - 43200.0) / 60.0, 14.2, 0.1) << "and in February";
}

TEST(SunEvents, NamesEqualThoseOfTheCommandLine) {
  const char* names[] = {"astronomical-dawn", "nautical-dawn", "civil-dawn",
                         "sunrise",           "noon",          "sunset",
                         "civil-dusk",        "nautical-dusk", "astronomical-dusk"};
  for (std::size_t i = 0; i < kInOrder.size(); ++i)
    EXPECT_EQ(SunEventFromName(names[i]), kInOrder[i]) << names[i];
  EXPECT_EQ(SunEventFromName("Noon"), std::nullopt);
  EXPECT_EQ(SunEventFromName("moonrise"), std::nullopt);
}

}  // namespace
}  // namespace alpenglow::atmosphere
