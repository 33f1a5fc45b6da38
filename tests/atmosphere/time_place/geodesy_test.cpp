// SPDX-License-Identifier: MIT
#include "atmosphere/time_place/geodesy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

double Distance(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

TEST(Geodesy, AxesOfTheEarthAreThoseOfWgs84) {
  const double b = kWgs84.equatorial_radius_m * (1.0 - kWgs84.flattening);
  EXPECT_NEAR(b, 6356752.314245, 1e-6) << "semi-minor axis, NIMA TR8350.2 table 3.1";
  const auto at = [](double latitude, double longitude, double height) {
    return EcefFromGeodetic(kWgs84, CheckedPlace({latitude, longitude, height})).xyz;
  };
  EXPECT_EQ(at(0, 0, 0), glm::dvec3(6378137.0, 0, 0));
  EXPECT_EQ(at(0, 90, 100), glm::dvec3(0, 6378237.0, 0));
  EXPECT_LT(Distance(at(90, 0, 0), {0, 0, b}), 1e-8) << "rounding of the axis itself is 1e-9 m";
  EXPECT_LT(Distance(at(-90, 17, 1000), {0, 0, -b - 1000}), 1e-8);
  EXPECT_EQ(at(90, 17, 0).x, 0.0) << "the pole is on the axis exactly";
}

// This is the closed form of the textbooks, N = a / sqrt(1 - e^2 sin^2), in long double.
glm::dvec3 TextbookEcef(long double latitude_rad, long double longitude_rad, double height_m) {
  const long double a = 6378137.0L, f = 1.0L / 298.257223563L, e2 = f * (2.0L - f);
  const long double sine = std::sin(latitude_rad), cosine = std::cos(latitude_rad);
  const long double n = a / std::sqrt(1.0L - e2 * sine * sine);
  const auto value = [](long double wide) { return static_cast<double>(wide); };
  return {value((n + height_m) * cosine * std::cos(longitude_rad)),
          value((n + height_m) * cosine * std::sin(longitude_rad)),
          value((n * (1.0L - e2) + height_m) * sine)};
}

TEST(Geodesy, EcefFollowsTheTextbookFormula) {
  for (const double latitude : {-89.9, -45.0, -0.001, 12.5, 35.3606, 60.0, 89.999}) {
    for (const double longitude : {-179.999, -74.0, 0.0, 7.6, 138.7274, 179.5}) {
      for (const double height : {-11000.0, 0.0, 3776.0, 400e3, 36e6}) {
        const Place place = CheckedPlace({latitude, longitude, height});
        EXPECT_LT(Distance(EcefFromGeodetic(kWgs84, place).xyz,
                           TextbookEcef(place.latitude_rad(), place.longitude_rad(), height)),
                  3e-8)
            << "a few roundings of 4e7 m in double";
      }
    }
  }
}

TEST(Geodesy, EcefRoundTripKeepsPlacesWithinTenNanometres) {
  for (const Ellipsoid& ellipsoid :
       {kWgs84, Ellipsoid{6371000.0, 0.0}, Ellipsoid{3396190.0, 0.00589}}) {
    for (const double latitude : {-90.0, -89.99999, -45.0, -1e-9, 0.0, 46.55, 89.9, 90.0}) {
      for (const double longitude : {-179.9999, -90.0, 0.0, 7.98, 180.0}) {
        for (const double height : {-11000.0, 0.0, 8848.0, 400e3}) {
          const Point<Ecef> point =
              EcefFromGeodetic(ellipsoid, CheckedPlace({latitude, longitude, height}));
          const Place back = GeodeticFromEcef(ellipsoid, point);
          EXPECT_NEAR(back.height_m, height, 1e-8);
          EXPECT_LT(Distance(EcefFromGeodetic(ellipsoid, back).xyz, point.xyz), 1e-8)
              << latitude << " " << longitude << " " << height;
          EXPECT_NEAR(back.latitude_rad(), latitude * kRadiansPerDegree, 1e-14);
        }
      }
    }
  }
}

// Hard case 27.
TEST(Geodesy, Longitudes180AndMinus180AreBitwiseEqual) {
  const Place east{-16.5, 180.0, 120.0};
  for (const Place& west : {CheckedPlace({-16.5, -180.0, 120.0}), Place{-16.5, -180.0, 120.0},
                            PlaceFromRadians(east.latitude_rad(), -kPi, 120.0),
                            PlaceFromRadians(east.latitude_rad(), kPi, 120.0)}) {
    const glm::dvec3 a = EcefFromGeodetic(kWgs84, east).xyz;
    const glm::dvec3 b = EcefFromGeodetic(kWgs84, west).xyz;
    EXPECT_EQ(a, b);
    EXPECT_EQ(std::signbit(a.y), std::signbit(b.y)) << "not even the sign of zero differs";
    const Vector<Enu> north = LocalFrame(kWgs84, west).EnuFromEcef(Vector<Ecef>{{1.0, 2.0, 3.0}});
    EXPECT_EQ(north.xyz, LocalFrame(kWgs84, east).EnuFromEcef(Vector<Ecef>{{1.0, 2.0, 3.0}}).xyz);
  }
  EXPECT_EQ(CheckedPlace({0, 190, 0}).longitude_deg, -170.0);
  EXPECT_EQ(CheckedPlace({0, 360, 0}).longitude_deg, 0.0);
}

TEST(Geodesy, LongitudesWrapIntoOneTurn) {
  EXPECT_EQ(WrappedLongitude(-180.0), 180.0);
  EXPECT_EQ(WrappedLongitude(180.0), 180.0);
  EXPECT_EQ(WrappedLongitude(1.25), 1.25);
  EXPECT_EQ(WrappedLongitude(1.25 + 1080.0), 1.25);
  EXPECT_EQ(WrappedLongitude(-1.25 - 360.0), -1.25);
  EXPECT_THROW((void)WrappedLongitude(kNotANumber), InputError);
}

TEST(Geodesy, LocalFrameIsARightHandedRotation) {
  for (const double latitude : {-90.0, -33.0, 0.0, 46.5, 90.0}) {
    const LocalFrame frame(kWgs84, CheckedPlace({latitude, -70.5, 2400.0}));
    const glm::dvec3 east = frame.EcefFromEnu(Vector<Enu>{{1, 0, 0}}).xyz;
    const glm::dvec3 north = frame.EcefFromEnu(Vector<Enu>{{0, 1, 0}}).xyz;
    const glm::dvec3 up = frame.EcefFromEnu(Vector<Enu>{{0, 0, 1}}).xyz;
    EXPECT_LT(Distance(glm::cross(east, north), up), 1e-15) << "a rounding";
    EXPECT_NEAR(glm::dot(east, north), 0.0, 1e-16);
    EXPECT_NEAR(glm::length(north), 1.0, 4e-16);
    EXPECT_EQ(east.z, 0.0) << "east is parallel to the equator";
  }
}

// Hard case 16.
TEST(Geodesy, LocalFrameIsInvertible) {
  const LocalFrame frame(kWgs84, Place{35.5, 138.76, 900.0});
  const Place above{35.5, 138.76, 1900.0};
  EXPECT_LT(Distance(frame.EnuFromGeodetic(above).xyz, {0, 0, 1000}), 1e-8)
      << "straight up is up; ECEF rounds to 1e-9 m";
  const Point<Enu> point{{-12345.6, 7890.1, 234.5}};
  EXPECT_LT(Distance(frame.EnuFromEcef(frame.EcefFromEnu(point)).xyz, point.xyz), 1e-8);
  EXPECT_LT(Distance(frame.EnuFromGeodetic(frame.GeodeticFromEnu(point)).xyz, point.xyz), 2e-8);
}

TEST(Geodesy, AMountain150KilometresAwayIsBelowTheHorizontal) {
  // On the equator looking along it the earth is a circle of radius a: a point at the arc s and the
  // height h lies at x = (a + h) sin(s / a), z = (a + h) cos(s / a) - a.
  const double a = kWgs84.equatorial_radius_m;
  const double arc = 150e3 / a;
  const LocalFrame frame(kWgs84, Place{0.0, 10.0, 0.0});
  const Place peak = PlaceFromRadians(0.0, 10.0 * kRadiansPerDegree + arc, 1500.0);
  const glm::dvec3 seen = frame.EnuFromGeodetic(peak).xyz;
  EXPECT_NEAR(seen.x, (a + 1500.0) * std::sin(arc), 1e-6);
  EXPECT_NEAR(seen.y, 0.0, 1e-6);
  EXPECT_NEAR(seen.z, (a + 1500.0) * std::cos(arc) - a, 1e-6) << "rounding of ECEF is 1e-9 m";
  EXPECT_NEAR(seen.z, 1500.0 - 1764.0, 1.0) << "s^2 / 2 a = 1763.9 m: the peak is out of sight";
}

TEST(Geodesy, AMountainInTheNorthSinksWithMeridianCurvature) {
  // Along a meridian the drop is s^2 / 2 M to first order, M = a (1 - e^2) / w^3.
  const Place here{45.0, 7.0, 0.0};
  const double f = kWgs84.flattening;
  const double e2 = f * (2.0 - f);
  const double m = kWgs84.equatorial_radius_m * (1.0 - e2) / std::pow(1.0 - 0.5 * e2, 1.5);
  const Place there = PlaceFromRadians(here.latitude_rad() + 150e3 / m, here.longitude_rad(), 0.0);
  const glm::dvec3 seen = LocalFrame(kWgs84, here).EnuFromGeodetic(there).xyz;
  EXPECT_NEAR(seen.z, -150e3 * 150e3 / (2.0 * m), 0.5)
      << "next orders: s^4 / 24 M^3 = 0.08 m and the change of M along 150 km, 0.2 m";
}

TEST(Geodesy, OsculatingRadiusIsTheGaussianMean) {
  const double a = kWgs84.equatorial_radius_m;
  const double b = a * (1.0 - kWgs84.flattening);
  EXPECT_NEAR(OsculatingRadius(kWgs84, 0.0), b, 1e-6) << "sqrt(b^2 / a * a)";
  EXPECT_NEAR(OsculatingRadius(kWgs84, kPi / 2), a * a / b, 1e-6) << "polar radius of curvature";
  EXPECT_NEAR(a * a / b, 6399593.6258, 1e-4) << "NIMA TR8350.2 table 3.3";
  EXPECT_EQ(OsculatingRadius({6360e3, 0.0}, 1.0), 6360e3);
  // Curvature is measured on the ellipsoid itself, from the sagitta of 1 km along and across.
  const Place here{52.0, 0.0, 0.0};
  const LocalFrame frame(kWgs84, here);
  const auto radius = [&](double east, double north) {
    const Place near =
        PlaceFromRadians(here.latitude_rad() + north, here.longitude_rad() + east, 0.0);
    const glm::dvec3 p = frame.EnuFromGeodetic(near).xyz;
    return glm::dot(p, p) / (-2.0 * p.z);
  };
  const double step = 1e-3;
  const double measured = std::sqrt(radius(step, 0.0) * radius(0.0, step));
  EXPECT_NEAR(OsculatingRadius(kWgs84, here.latitude_rad()), measured, 40.0)
      << "the chord of 6 km sees the change of curvature along it, 5e-6 of the radius";
}

// Hard case 3.
TEST(Geodesy, ImpossiblePlacesAreRefusedByName) {
  const struct {
    double latitude, longitude, height_m;
    const char* fault;
  } places[] = {
      {90, 360, -12000, "no fault"},
      {90.0000001, 0, 0, "latitude is 90.0000001; it must lie in [-90, 90]"},
      {-91, 0, 0, "latitude is -91; it must lie in [-90, 90]"},
      {0, 540, 0, "longitude is 540; it must lie in [-180, 360]"},
      {0, kNotANumber, 0, "longitude is nan"},
      {kNotANumber, 0, 0, "latitude is nan"},
      {0, 0, -12001, "height_m is -12001; it must be finite and at least -12000"},
      {0, 0, kInfinite, "height_m is inf"},
      {0, 0, kNotANumber, "height_m is nan"},
  };
  for (const auto& place : places) {
    EXPECT_THAT(tests::FaultOf([&] {
                  return CheckedPlace({place.latitude, place.longitude, place.height_m});
                }),
                testing::StartsWith(place.fault));
  }
}

// Hard case 3.
TEST(Geodesy, NonFiniteInputGivesNoPlace) {
  EXPECT_THROW((void)EcefFromGeodetic(kWgs84, {91.7, 0.0, 0.0}), InputError);
  EXPECT_THROW((void)EcefFromGeodetic(kWgs84, {kNotANumber, 0.0, 0.0}), InputError);
  EXPECT_THROW((void)EcefFromGeodetic(kWgs84, {0.0, kInfinite, 0.0}), InputError);
  EXPECT_THROW((void)EcefFromGeodetic(kWgs84, {0.0, 0.0, kNotANumber}), InputError);
  EXPECT_THROW((void)EcefFromGeodetic({-1.0, 0.0}, {}), InputError);
  EXPECT_THROW((void)EcefFromGeodetic({6e6, 1.5}, {}), InputError);
  EXPECT_TRUE(std::isnan(GeodeticFromEcef(kWgs84, {{kNotANumber, 0.0, 0.0}}).height_m));
}

TEST(Geodesy, CentreOfTheEarthIsBelowTheNorthPole) {
  const Place centre = GeodeticFromEcef(kWgs84, {});
  EXPECT_EQ(centre.latitude_rad(), kPi / 2);
  EXPECT_NEAR(centre.height_m, -6356752.314245, 1e-6);
}

}  // namespace
}  // namespace alpenglow::atmosphere
