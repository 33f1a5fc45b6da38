// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/sun.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/places.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kSunArcsecond_rad = kRadiansPerDegree / 3600.0;

/// Angle on the sky: near the zenith and at the poles an azimuth alone says little.
double Separation(const Vector<Enu>& a, const Vector<Enu>& b) {
  return std::atan2(glm::length(glm::cross(a.xyz, b.xyz)), glm::dot(a.xyz, b.xyz));
}

// Reda and Andreas (2004), Solar Energy 76, 577-589 (NREL/TP-560-34302), table A5.1.
TEST(Sun, ExampleOfTheNrelSolarPositionAlgorithm) {
  const SunPosition sun = SunAt(PlaceFromDegrees(39.742476, -105.1786, 1830.14),
                                ParseInstant("2003-10-17T12:30:30-07:00"), 67.0);
  const double elevation = sun.elevation_rad / kRadiansPerDegree;
  EXPECT_NEAR(sun.azimuth_rad / kRadiansPerDegree, 194.34024, 0.0003) << "SPA's own tolerance";
  // Published: zenith angle 50.11162 with refraction at 820 mbar and 11 C, by equation 42 of SPA.
  const double spa_refraction =
      820.0 / 1010.0 * 283.0 / (273.0 + 11.0) * 1.02 /
      (60.0 * std::tan((elevation + 10.3 / (elevation + 5.11)) * kRadiansPerDegree));
  EXPECT_NEAR(90.0 - elevation - spa_refraction, 50.11162, 0.0003) << "SPA's own tolerance";
  const double ours =
      Refraction(sun.elevation_rad, AirAtObserver{82000.0, 284.15}) / kRadiansPerDegree;
  EXPECT_NEAR(ours, spa_refraction, 0.001)
      << "Saemundsson's formula, which SPA uses, is 5 % (0.0008 degrees) high at 40 degrees";
}

struct SpaRow {
  std::string utc;
  double latitude, longitude, height_m, delta_t_s, azimuth, elevation, distance_au;
};

double ErrorInArcseconds(const SpaRow& row) {
  const SunPosition sun = SunAt(PlaceFromDegrees(row.latitude, row.longitude, row.height_m),
                                ParseInstant(row.utc), row.delta_t_s);
  EXPECT_NEAR(sun.distance_au, row.distance_au, 6e-5)
      << "theirs is from the centre of the earth, ours from the place: 4.3e-5 au";
  return Separation(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad),
                    DirectionFromAngles(row.elevation * kRadiansPerDegree,
                                        row.azimuth * kRadiansPerDegree)) /
         kSunArcsecond_rad;
}

// Rows of an independent implementation of SPA (npm nrel-spa 2.0.2), without refraction.
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

TEST(Sun, StandsWhereSpaPutsItWithinTwoArcseconds) {
  for (const SpaRow& row : kSpaRows) EXPECT_LT(ErrorInArcseconds(row), 2.0) << row.utc;
}

double Number(const std::string& text) {
  double value = std::nan("");
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

TEST(Sun, WholeTableOfSpaIsMatchedWithinTwoArcseconds) {
  const std::filesystem::path path =
      std::filesystem::path(tests::kSharedFolder) / "tables" / "sun_nrel_spa.csv";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << "the reference table is not here: " << path;
  int rows = 0;
  double largest = 0.0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#' || line.rfind("utc", 0) == 0) continue;
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 8U) << line;
    const double error =
        ErrorInArcseconds({cells[0], Number(cells[1]), Number(cells[2]), Number(cells[3]),
                           Number(cells[4]), Number(cells[5]), Number(cells[6]), Number(cells[7])});
    EXPECT_LT(error, 2.0) << line;
    largest = std::max(largest, error);
    ++rows;
  }
  EXPECT_GT(rows, 200);
  RecordProperty("largest_error_arcseconds", std::to_string(largest));
  std::cout << rows << " rows, largest error " << largest << " arcseconds\n";
}

TEST(Sun, DirectionAndAnglesSayTheSame) {
  for (const double latitude : {-90.0, -33.0, 0.0, 46.5, 90.0}) {
    for (int hour = 0; hour < 24; hour += 3) {
      const GeodeticPosition place = PlaceFromDegrees(latitude, 8.0, 500.0);
      const SunPosition sun = SunAt(place, AddSeconds(UtcInstant{61041, 0.0}, 3600.0 * hour));
      EXPECT_NEAR(glm::length(sun.direction.xyz), 1.0, 1e-15);
      const Vector<Enu> local = LocalFrame(kWgs84, place).EnuFromEcef(sun.direction);
      EXPECT_LT(Separation(local, DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad)), 1e-14);
      EXPECT_GE(sun.azimuth_rad, 0.0);
      EXPECT_LT(sun.azimuth_rad, 2.0 * kPi);
    }
  }
}

TEST(Sun, AzimuthCountsFromNorthOverEast) {
  EXPECT_LT(Separation(DirectionFromAngles(0.0, 0.0), {{0, 1, 0}}), 1e-16);
  EXPECT_LT(Separation(DirectionFromAngles(0.0, kPi / 2), {{1, 0, 0}}), 1e-16);
  EXPECT_LT(Separation(DirectionFromAngles(kPi / 2, 1.0), {{0, 0, 1}}), 1e-16);
  const GeodeticPosition zurich = PlaceFromDegrees(47.4, 8.5, 0.0);
  const double morning = SunAt(zurich, ParseInstant("2026-03-20T06:00:00Z")).azimuth_rad;
  const double evening = SunAt(zurich, ParseInstant("2026-03-20T17:00:00Z")).azimuth_rad;
  EXPECT_NEAR(morning / kRadiansPerDegree, 90.0, 10.0) << "it rises in the east";
  EXPECT_NEAR(evening / kRadiansPerDegree, 270.0, 10.0);
}

TEST(Sun, IsLargestAtPerihelion) {
  const GeodeticPosition place = PlaceFromDegrees(0.0, 0.0, 0.0);
  // Perihelion and aphelion of 2024, USNO: 3 January 01h, 5 July 05h.
  const SunPosition near = SunAt(place, ParseInstant("2024-01-03T01:00:00Z"));
  const SunPosition far = SunAt(place, ParseInstant("2024-07-05T05:00:00Z"));
  EXPECT_NEAR(near.distance_au, 0.98331, 6e-5) << "the place is 4.3e-5 au from the centre";
  EXPECT_NEAR(far.distance_au, 1.01673, 6e-5);
  EXPECT_NEAR(near.angular_radius_rad * near.distance_au, kSunAngularRadius_rad, 1e-7);
  EXPECT_GT(near.angular_radius_rad, far.angular_radius_rad);
}

// Hard case 27.
TEST(Sun, ExactPolesHaveOneElevationAndAzimuthsThatFollowTheLongitude) {
  const UtcInstant instant = ParseInstant("2026-06-21T09:00:00Z");
  for (const double latitude : {-90.0, 90.0}) {
    const SunPosition a = SunAt(PlaceFromDegrees(latitude, 0.0, 0.0), instant);
    const SunPosition b = SunAt(PlaceFromDegrees(latitude, 120.0, 0.0), instant);
    EXPECT_NEAR(a.elevation_rad, b.elevation_rad, 1e-15);
    EXPECT_NEAR(std::abs(a.elevation_rad) / kRadiansPerDegree, 23.44, 0.01) << "solstice";
    const double turn = (latitude > 0 ? 1.0 : -1.0) * (b.azimuth_rad - a.azimuth_rad);
    EXPECT_NEAR(std::remainder(turn - 120.0 * kRadiansPerDegree, 2.0 * kPi), 0.0, 1e-14);
  }
}

// Hard case 27.
TEST(Sun, Longitudes180AndMinus180AreIdentical) {
  for (const double latitude : {-90.0, -16.5, 0.0, 65.0, 90.0}) {
    const UtcInstant instant = ParseInstant("2026-02-11T20:17:00Z");
    const SunPosition east = SunAt(PlaceFromDegrees(latitude, 180.0, 10.0), instant);
    for (const GeodeticPosition& place :
         {PlaceFromDegrees(latitude, -180.0, 10.0),
          GeodeticPosition{latitude * kRadiansPerDegree, -kPi, 10.0}}) {
      const SunPosition west = SunAt(place, instant);
      EXPECT_EQ(east.elevation_rad, west.elevation_rad);
      EXPECT_EQ(east.azimuth_rad, west.azimuth_rad);
      EXPECT_EQ(east.distance_au, west.distance_au);
      EXPECT_EQ(east.direction.xyz, west.direction.xyz);
    }
  }
}

// Hard case 25.
TEST(Sun, ALeapSecondMovesItNoFurtherThanAnyOther) {
  const GeodeticPosition place = PlaceFromDegrees(-33.9, 151.2, 0.0);
  std::vector<Vector<Enu>> seen;
  for (const char* text : {"2016-12-31T23:59:58Z", "2016-12-31T23:59:59Z", "2016-12-31T23:59:60Z",
                           "2017-01-01T00:00:00Z", "2017-01-01T00:00:01Z"}) {
    const SunPosition sun = SunAt(place, ParseInstant(text));
    seen.push_back(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad));
  }
  EXPECT_NEAR(Separation(seen[0], seen[1]) / kSunArcsecond_rad, 13.8, 0.1)
      << "15 arcseconds * cos 23";
  EXPECT_NEAR(Separation(seen[1], seen[2]) / kSunArcsecond_rad, 13.8, 0.1);
  EXPECT_LT(Separation(seen[2], seen[3]) / kSunArcsecond_rad, 0.05)
      << "UT1 = UTC repeats the second; only TT goes on, by 0.04 arcseconds of the orbit";
  EXPECT_NEAR(Separation(seen[3], seen[4]) / kSunArcsecond_rad, 13.8, 0.1);
}

TEST(Sun, YearsThatErfaCallsDubiousAreAnsweredAndContinuous) {
  const GeodeticPosition place = PlaceFromDegrees(35.5, 138.8, 900.0);
  for (const char* text : {"1900-01-01T00:00:00Z", "1959-12-31T23:59:59Z", "2026-12-31T23:59:59Z",
                           "2100-12-31T23:59:58Z"}) {
    const UtcInstant instant = ParseInstant(text);
    const SunPosition now = SunAt(place, instant);
    const SunPosition next = SunAt(place, AddSeconds(instant, 1.0));
    const double moved = Separation(DirectionFromAngles(now.elevation_rad, now.azimuth_rad),
                                    DirectionFromAngles(next.elevation_rad, next.azimuth_rad));
    EXPECT_NEAR(moved / kSunArcsecond_rad, 13.8, 0.1) << text << ": 15 arcseconds * cos 23";
  }
}

TEST(Sun, FollowsTheRotationOfTheEarthNotOnlyTheClock) {
  // A second of delta-T moves the ephemeris, not the clock: 0.04 arcseconds, not 15.
  const GeodeticPosition place = PlaceFromDegrees(10.0, 20.0, 0.0);
  const UtcInstant instant = ParseInstant("2026-06-21T12:00:00Z");
  const SunPosition a = SunAt(place, instant, 69.0);
  const SunPosition b = SunAt(place, instant, 70.0);
  EXPECT_LT(Separation(DirectionFromAngles(a.elevation_rad, a.azimuth_rad),
                       DirectionFromAngles(b.elevation_rad, b.azimuth_rad)) /
                kSunArcsecond_rad,
            0.05);
}

TEST(Sun, ClimbsUntilNoonAndSinksAfterwards) {
  const GeodeticPosition place = PlaceFromDegrees(46.5, 8.0, 2000.0);
  const UtcInstant day = ParseInstant("2026-04-18T00:00:00Z");
  const UtcInstant noon = FindSunEvent(SunEvent::kNoon, place, AddSeconds(day, 43200.0)).value();
  double before = -kPi;
  for (double time_s = -11.5 * 3600; time_s <= -300.0; time_s += 900.0) {
    const double elevation = SunAt(place, AddSeconds(noon, time_s)).elevation_rad;
    EXPECT_GT(elevation, before);
    before = elevation;
  }
  before = kPi;
  for (double time_s = 300.0; time_s <= 11.5 * 3600; time_s += 900.0) {
    const double elevation = SunAt(place, AddSeconds(noon, time_s)).elevation_rad;
    EXPECT_LT(elevation, before);
    before = elevation;
  }
}

TEST(Sun, BadPlacesAreRefused) {
  EXPECT_THROW((void)SunAt({std::nan(""), 0.0, 0.0}, {}), InputError);
  EXPECT_THROW((void)SunAt({2.0, 0.0, 0.0}, {}), InputError);
}

}  // namespace
}  // namespace alpenglow::atmosphere
