// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/sun_and_moon.h>
#include <gtest/gtest.h>

#include <erfa.h>

#include <cmath>
#include <glm/mat3x3.hpp>
#include <limits>
#include <vector>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow {
namespace {

using atmosphere::kRadiansPerDegree;

constexpr Place kFuji{35.36, 138.73, 2500.0};

TEST(PlaceTime, TextsSurviveARoundTrip) {
  const UtcTime time = TimeFromText("2026-06-21T13:00:00+09:00");
  EXPECT_EQ(TextFromTime(time), "2026-06-21T04:00:00Z");
  EXPECT_EQ(time, TimeFromText("2026-06-21T13:00:00", "Asia/Tokyo"));
  EXPECT_EQ(time, std::chrono::sys_days{std::chrono::year{2026} / 6 / 21} + std::chrono::hours{4});
  EXPECT_EQ(TextFromTime(TimeFromText("1933-12-31T23:59:59.5Z")), "1934-01-01T00:00:00Z");
}

/// Returns the elevation of the sun without refraction, from series that are summed for this instant.
double SummedElevation_rad(const Place& place, const UtcTime& time) {
  const double delta_t_s = atmosphere::DeltaT(time);
  const auto [day, part] = atmosphere::TerrestrialTimeAt(time, delta_t_s);
  double heliocentric[2][3], barycentric[2][3], axes[3][3];
  eraEpv00(day, part, heliocentric, barycentric);
  const double ut_day = atmosphere::kModifiedJulianEpoch + time.modified_julian_day;
  eraC2t06a(day, part, ut_day, time.second_of_day / 86400.0, 0.0, 0.0, axes);
  atmosphere::EarthAndSun bodies{};
  glm::dmat3 ecef_from_gcrs(0.0);
  for (int i = 0; i < 3; ++i) {
    bodies.earth.position_au[i] = barycentric[0][i];
    bodies.earth.velocity_au_per_day[i] = barycentric[1][i];
    bodies.sun.position_au[i] = barycentric[0][i] - heliocentric[0][i];
    bodies.sun.velocity_au_per_day[i] = barycentric[1][i] - heliocentric[1][i];
    for (int k = 0; k < 3; ++k) ecef_from_gcrs[k][i] = axes[i][k];
  }
  return atmosphere::SeenFrom(atmosphere::WithWrappedLongitude(place), ecef_from_gcrs, bodies,
                              bodies.sun)
      .elevation_rad;
}

using SystemTime = std::chrono::sys_time<std::chrono::microseconds>;

TEST(PlaceTime, LeapSecondsBecomeTheFirstSecondOfTheNextDay) {
  const UtcTime leap = TimeFromText("2016-12-31T23:59:60Z");
  const UtcTime next = TimeFromText("2017-01-01T00:00:00Z");
  EXPECT_EQ(SystemTime(leap), SystemTime(next));
  EXPECT_EQ(next - leap, std::chrono::seconds(0));
  EXPECT_LT(leap, next);
  EXPECT_EQ(TextFromTime(leap), "2016-12-31T23:59:60Z");
  EXPECT_EQ(TextFromTime(leap + std::chrono::seconds(1)), "2017-01-01T00:00:01Z");
}

TEST(PlaceTime, TimesOfTheSystemClockSurviveARoundTrip) {
  for (const std::int64_t count : {0LL, 1LL, -1LL, 1700000000123456LL, -2208988800000000LL}) {
    const std::chrono::microseconds since_1970(count);
    EXPECT_EQ(SystemTime(UtcTime(since_1970)), SystemTime(since_1970));
    EXPECT_EQ(UtcTime(since_1970), UtcTime(SystemTime(since_1970)));
  }
  EXPECT_EQ(UtcTime(), SystemTime());
}

TEST(PlaceTime, DurationsCanBeAddedToATime) {
  UtcTime time = TimeFromText("2026-06-21T13:00:00Z");
  const UtcTime begin = time;
  time += std::chrono::hours(11);
  EXPECT_EQ(TextFromTime(time), "2026-06-22T00:00:00Z");
  EXPECT_EQ(time - begin, std::chrono::hours(11));
  time -= std::chrono::milliseconds(39600500);
  EXPECT_EQ(begin - time, std::chrono::milliseconds(500));
  EXPECT_THROW((void)(time + std::chrono::duration<double>(std::nan(""))), InputError);
}

TEST(PlaceTime, WrongTextsAreRefused) {
  EXPECT_THROW((void)TimeFromText("noon"), InputError);
  EXPECT_THROW((void)TimeFromText("2026-06-21T13:00:00", "Asia/Atlantis"), InputError);
}

TEST(PlaceTime, YearsWithoutKnownPositionsAreRefused) {
  const auto new_year = [](int year) {
    return UtcTime(std::chrono::sys_days(std::chrono::year(year) / 1 / 1));
  };
  for (const UtcTime time :
       {new_year(1899), new_year(2101), new_year(3000), new_year(20000), UtcTime(SystemTime::min()),
        UtcTime(SystemTime::max()), UtcTime(std::numeric_limits<int>::min(), 0.0),
        UtcTime(std::numeric_limits<int>::max(), 0.0)}) {
    EXPECT_THROW((void)SunAt(kFuji, time), InputError);
    EXPECT_THROW((void)MoonAt(kFuji, time), InputError);
    EXPECT_THROW((void)SunEventTime("noon", kFuji, time), InputError);
    EXPECT_THROW((void)TextFromTime(time), InputError);
  }
  for (const double second : {-1.0, 86400.0, std::nan("")})
    EXPECT_THROW((void)TextFromTime(UtcTime(61212, second)), InputError) << second;
  EXPECT_EQ(TextFromTime(new_year(1900)), "1900-01-01T00:00:00Z");
  EXPECT_EQ(TextFromTime(new_year(2101) - std::chrono::seconds(1)), "2100-12-31T23:59:59Z");
}

TEST(SunInSky, EqualsTheSunOfTheLayerBelow) {
  const auto medium =
      atmosphere::OnOsculatingSphere(atmosphere::MediumPreset("earth"), 35.36 * kRadiansPerDegree);
  const auto place = Place{35.36, 138.73, 2500.0};
  const auto instant = atmosphere::ParseInstant("2026-06-21T09:30:00Z");
  const auto expected = atmosphere::ApparentSunAt(place, instant, atmosphere::GentleAirOf(medium));
  const SunInSky sun = SunAt(kFuji, TimeFromText("2026-06-21T09:30:00Z"));
  EXPECT_EQ(sun.elevation_deg, expected.elevation_deg);
  EXPECT_EQ(sun.azimuth_deg, expected.azimuth_deg);
  EXPECT_EQ(sun.distance_au, expected.distance_au);
  EXPECT_GT(sun.ToSun().up, sun.ToSunForAir().up);
}

TEST(MoonInSky, EqualsTheMoonOfTheLayerBelow) {
  const auto medium =
      atmosphere::OnOsculatingSphere(atmosphere::MediumPreset("earth"), 35.36 * kRadiansPerDegree);
  const auto expected = atmosphere::ApparentMoonAt(Place{35.36, 138.73, 2500.0},
                                                   atmosphere::ParseInstant("2026-06-21T09:30:00Z"),
                                                   atmosphere::GentleAirOf(medium));
  const MoonInSky moon = MoonAt(kFuji, TimeFromText("2026-06-21T09:30:00Z"));
  EXPECT_EQ(moon.elevation_deg, expected.elevation_deg);
  EXPECT_EQ(moon.azimuth_deg, expected.azimuth_deg);
  EXPECT_EQ(moon.illuminated_fraction, expected.illuminated_fraction);
}

TEST(SunEventTime, EqualsThatOfTheLayerBelow) {
  const auto noon = TimeFromText("2026-06-21T03:00:00Z");
  const std::optional<UtcTime> sunset = SunEventTime("sunset", kFuji, noon);
  const auto expected =
      atmosphere::FindSunEvent(atmosphere::SunEvent::kSunset, Place{35.36, 138.73, 2500.0},
                               atmosphere::ParseInstant("2026-06-21T03:00:00Z"));
  ASSERT_TRUE(sunset);
  EXPECT_EQ(sunset, expected);
  EXPECT_EQ(SunEventTime("sunset", {80.0, 0.0, 0.0}, noon), std::nullopt);
}

TEST(SunsAt, EqualTheSunOfEachInstant) {
  const UtcTime begin = TimeFromText("2026-03-01T00:00:00Z");
  std::vector<UtcTime> times;
  for (int i = 0; i < 200; ++i) times.push_back(begin + std::chrono::minutes(1700 * i));
  const std::vector<SunInSky> suns = SunsAt(kFuji, times);
  const auto sunsets = SunEventTimes("sunset", kFuji, times);
  ASSERT_EQ(suns.size(), times.size());
  ASSERT_EQ(sunsets.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const SunInSky one = SunAt(kFuji, times[i]);
    EXPECT_EQ(suns[i].elevation_deg, one.elevation_deg);
    EXPECT_EQ(suns[i].azimuth_deg, one.azimuth_deg);
    EXPECT_EQ(suns[i].lower_for_air_deg, one.lower_for_air_deg);
    EXPECT_EQ(sunsets[i], SunEventTime("sunset", kFuji, times[i]));
  }
  times[7].second_of_day = -1.0;
  EXPECT_THROW((void)SunsAt(kFuji, times), InputError);
  EXPECT_THROW((void)SunEventTimes("sunset", kFuji, times), InputError);
  EXPECT_TRUE(SunEventTimes("noon", kFuji, {}).empty());
  EXPECT_THROW((void)SunEventTimes("tea", kFuji, {}), InputError);
}

// The slow way sums the series of ERFA, and finds the elevation by halving intervals over the
// refraction of rays. The bound is 1e-7 degrees, 0.4 milliarcseconds, far below that of the sun's
// place.
TEST(SunAt, AgreesWithSummedSeriesAndIntegratedRefraction) {
  const atmosphere::Medium medium = Atmosphere().medium();
  for (int i = 0; i < 40; ++i) {
    const UtcTime time =
        TimeFromText("1999-11-03T00:00:00Z") + std::chrono::minutes(377 * 1440 * i / 40 + 97 * i);
    const Place place{-60.0 + 3.0 * i, 9.0 * i, 75.0 * i};
    const atmosphere::BendingAir air =
        atmosphere::GentleAirOf(medium, atmosphere::OsculatingRadius(medium, place.latitude_rad()));
    const SunInSky sun = SunAt(place, time);
    const double true_rad = SummedElevation_rad(place, time);
    if (true_rad < 0.01) continue;
    double low = true_rad, high = true_rad + 0.02;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      const double rest =
          middle - atmosphere::RefractionSeenAt(air, middle, place.height_m) - true_rad;
      (rest < 0.0 ? low : high) = middle;
    }
    EXPECT_NEAR(sun.elevation_deg, low / kRadiansPerDegree, 1e-7) << i;
  }
}

TEST(SunEventTime, UnknownNamesAndPlacesAreRefused) {
  EXPECT_THROW((void)SunEventTime("tea", kFuji, {}), InputError);
  EXPECT_THROW((void)SunAt({91.0, 0.0, 0.0}, {}), InputError);
}

TEST(DirectionFromAngles, MeasuresAzimuthFromNorthOverEast) {
  const Direction east = DirectionFromAngles(0.0, 90.0);
  EXPECT_NEAR(east.east, 1.0, 1e-15);
  EXPECT_NEAR(east.north, 0.0, 1e-15);
  EXPECT_EQ(east.up, 0.0);
}

}  // namespace
}  // namespace alpenglow
