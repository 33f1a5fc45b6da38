// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/sun_and_moon.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/refracted_view.h"

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
