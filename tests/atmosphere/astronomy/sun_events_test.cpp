// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere {
namespace {

constexpr std::array kInOrder = {
    SunEvent::kAstronomicalDawn, SunEvent::kNauticalDawn, SunEvent::kCivilDawn,
    SunEvent::kSunrise,          SunEvent::kNoon,         SunEvent::kSunset,
    SunEvent::kCivilDusk,        SunEvent::kNauticalDusk, SunEvent::kAstronomicalDusk};

double SecondsOff(SunEvent event, const GeodeticPosition& place, const std::string& published) {
  const UtcInstant expected = ParseInstant(published);
  const std::optional<UtcInstant> found = FindSunEvent(event, place, expected);
  EXPECT_TRUE(found.has_value());
  return found ? SecondsBetween(expected, *found) : 1e9;
}

// United States Naval Observatory, "Sun and Moon data for one day", Atlanta, 6 September 2009, at
// 33.8 N 84.4 W; quoted in the manual of PyEphem, "Rising, Transit, Setting".
TEST(SunEvents, AtlantaIsAsTheNavalObservatoryPrintsIt) {
  const GeodeticPosition atlanta = PlaceFromDegrees(33.8, -84.4, 0.0);
  const char* tolerance = "printed to the minute, plus 4 s for the sun's radius, 16' there";
  const auto off = [&](SunEvent event, const char* time) {
    return SecondsOff(event, atlanta, std::string("2009-09-06T") + time + ":00-04:00");
  };
  EXPECT_NEAR(off(SunEvent::kCivilDawn, "06:50"), 0.0, 34.0) << tolerance;
  EXPECT_NEAR(off(SunEvent::kSunrise, "07:15"), 0.0, 34.0) << tolerance;
  EXPECT_NEAR(off(SunEvent::kNoon, "13:36"), 0.0, 34.0) << tolerance;
  EXPECT_NEAR(off(SunEvent::kSunset, "19:56"), 0.0, 34.0) << tolerance;
  EXPECT_NEAR(off(SunEvent::kCivilDusk, "20:21"), 0.0, 34.0) << tolerance;
}

// Skyfield with JPL DE421, its manual, "Almanac Computation"; the sun's radius is 16' there.
TEST(SunEvents, BlufftonIsAsTheJplEphemerisSays) {
  const GeodeticPosition bluffton = PlaceFromDegrees(40.8939, -83.8917, 0.0);
  const char* rising = "16' are 0.3' short of the radius in November: 2 s";
  const char* twilight = "UT1 - UTC of 0.2 s, and the ephemerides";
  const auto off = [&](SunEvent event, const char* time) {
    return SecondsOff(event, bluffton, std::string("2019-11-08T") + time + "Z");
  };
  EXPECT_NEAR(off(SunEvent::kAstronomicalDawn, "10:40:19"), 0.0, 1.5) << twilight;
  EXPECT_NEAR(off(SunEvent::kNauticalDawn, "11:12:31"), 0.0, 1.5) << twilight;
  EXPECT_NEAR(off(SunEvent::kCivilDawn, "11:45:18"), 0.0, 1.5) << twilight;
  EXPECT_NEAR(off(SunEvent::kSunrise, "12:14:15"), 0.0, 4.0) << rising;
  EXPECT_NEAR(off(SunEvent::kSunset, "22:23:52"), 0.0, 4.0) << rising;
  EXPECT_NEAR(off(SunEvent::kCivilDusk, "22:52:48"), 0.0, 1.5) << twilight;
  EXPECT_NEAR(off(SunEvent::kNauticalDusk, "23:25:34"), 0.0, 1.5) << twilight;
  EXPECT_NEAR(off(SunEvent::kAstronomicalDusk, "23:57:44"), 0.0, 1.5) << twilight;
}

TEST(SunEvents, NoonOfTheSpaExampleIsItsTransit) {
  // Reda and Andreas (2004), table A5.1: transit 18:46:04.97 UT.
  EXPECT_NEAR(SecondsOff(SunEvent::kNoon, PlaceFromDegrees(39.742476, -105.1786, 1830.14),
                         "2003-10-17T18:46:04.97Z"),
              0.0, 0.5)
      << "their transit is interpolated between days";
}

TEST(SunEvents, FollowEachOtherThroughTheDay) {
  for (const double latitude : {-47.0, -20.0, 0.0, 20.0, 47.0}) {
    for (const double longitude : {-180.0, -100.0, 0.0, 8.0, 138.0}) {
      for (const char* day :
           {"2026-03-20T12:00:00Z", "2026-06-21T00:00:00Z", "2026-12-21T23:59:59Z"}) {
        const GeodeticPosition place = PlaceFromDegrees(latitude, longitude, 300.0);
        std::optional<UtcInstant> before;
        for (const SunEvent event : kInOrder) {
          const std::optional<UtcInstant> found = FindSunEvent(event, place, ParseInstant(day));
          ASSERT_TRUE(found.has_value()) << latitude << " " << longitude << " " << day;
          if (before) {
            EXPECT_GT(SecondsBetween(*before, *found), 600.0) << latitude << " " << day;
          }
          before = found;
        }
      }
    }
  }
}

TEST(SunEvents, EveryInstantOfASolarDayFindsTheSameEvents) {
  const GeodeticPosition place = PlaceFromDegrees(35.36, 138.73, 0.0);  // 9 h 15 min before UTC
  const UtcInstant sunrise =
      FindSunEvent(SunEvent::kSunrise, place, ParseInstant("2026-06-21T04:00:00Z")).value();
  EXPECT_EQ(FormatInZone(sunrise, "Asia/Tokyo").substr(0, 13), "2026-06-21T04");
  for (const char* text :
       {"2026-06-20T14:50:00Z", "2026-06-20T18:00:00Z", "2026-06-21T14:40:00Z"}) {
    EXPECT_EQ(FindSunEvent(SunEvent::kSunrise, place, ParseInstant(text)), sunrise) << text;
  }
  const UtcInstant next =
      FindSunEvent(SunEvent::kSunrise, place, ParseInstant("2026-06-21T14:50:00Z")).value();
  EXPECT_NEAR(SecondsBetween(sunrise, next), 86400.0, 60.0) << "a day later";
}

TEST(SunEvents, SearchIsWithinATenthOfASecond) {
  for (const double latitude : {0.0, 51.0, 66.0}) {
    const GeodeticPosition place = PlaceFromDegrees(latitude, 25.0, 900.0);
    const double radius_m = OsculatingRadius(kWgs84, place.latitude_rad);
    const double target = SeaHorizonFrom(place.height_m, radius_m).true_elevation_rad;
    const UtcInstant found =
        FindSunEvent(SunEvent::kSunrise, place, ParseInstant("2026-03-01T12:00:00Z")).value();
    const auto above = [&](double offset_s) {
      const SunPosition sun = SunAt(place, AddSeconds(found, offset_s));
      return sun.elevation_rad + sun.angular_radius_rad - target;
    };
    EXPECT_LT(above(-0.1), 0.0);
    EXPECT_GT(above(0.1), 0.0);
  }
}

TEST(SunEvents, AtSunriseTheUpperLimbIsSeenOnTheSea) {
  const GeodeticPosition place = PlaceFromDegrees(35.36, 138.73, 3776.0);
  const UtcInstant sunrise =
      FindSunEvent(SunEvent::kSunrise, place, ParseInstant("2026-01-01T00:00:00Z")).value();
  const SunPosition sun = SunAt(place, sunrise);
  const double limb = sun.elevation_rad + sun.angular_radius_rad;
  const double radius_m = OsculatingRadius(kWgs84, place.latitude_rad);
  EXPECT_NEAR(limb + RefractionFromHeight(limb, place.height_m, radius_m),
              -SeaHorizonFrom(place.height_m, radius_m).dip_rad, 1e-6)
      << "0.01 s of the search are 7e-7";
}

TEST(SunEvents, TheSunRisesEarlierOnASummit) {
  const UtcInstant day = ParseInstant("2026-03-20T12:00:00Z");
  const auto sunrise = [&](double height) {
    return FindSunEvent(SunEvent::kSunrise, PlaceFromDegrees(0.0, 0.0, height), day).value();
  };
  const double earlier_s = SecondsBetween(sunrise(3776.0), sunrise(0.0));
  EXPECT_NEAR(earlier_s, 2.12 * std::sqrt(3776.0) * 4.0, 15.0)
      << "2.12' sqrt(height) and 4 s a minute of arc on the equator; the model differs by 2 %";
  EXPECT_NEAR(SecondsBetween(sunrise(-400.0), sunrise(0.0)), 0.0, 0.02)
      << "no dip below the sea; each search is within 0.01 s";
}

// Hard case 24.
TEST(SunEvents, PolarDayHasNoonAndNothingElse) {
  const GeodeticPosition tromso = PlaceFromDegrees(69.65, 18.96, 0.0);
  const UtcInstant midsummer = ParseInstant("2026-06-21T12:00:00Z");
  for (const SunEvent event : kInOrder) {
    EXPECT_EQ(FindSunEvent(event, tromso, midsummer).has_value(), event == SunEvent::kNoon);
  }
}

// Hard case 24.
TEST(SunEvents, PolarNightHasTwilightsAsDeepAsTheSunIs) {
  const UtcInstant midwinter = ParseInstant("2026-12-21T12:00:00Z");
  const auto has = [&](SunEvent event, double latitude) {
    return FindSunEvent(event, PlaceFromDegrees(latitude, 18.0, 0.0), midwinter).has_value();
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
  const GeodeticPosition petersburg = PlaceFromDegrees(59.94, 30.31, 0.0);
  const UtcInstant day = ParseInstant("2026-06-21T09:00:00Z");
  EXPECT_TRUE(FindSunEvent(SunEvent::kSunset, petersburg, day).has_value());
  EXPECT_FALSE(FindSunEvent(SunEvent::kNauticalDusk, petersburg, day).has_value());
  EXPECT_FALSE(FindSunEvent(SunEvent::kAstronomicalDawn, petersburg, day).has_value());
}

// Hard case 27.
TEST(SunEvents, AtThePolesTheSunRisesOnceAYear) {
  for (const double latitude : {-90.0, 90.0}) {
    int sunrises = 0;
    int sunsets = 0;
    for (int day = 0; day < 16; ++day) {  // 12 to 27 March
      const UtcInstant around = AddSeconds(ParseInstant("2026-03-12T12:00:00Z"), 86400.0 * day);
      const GeodeticPosition pole = PlaceFromDegrees(latitude, 0.0, 0.0);
      sunrises += FindSunEvent(SunEvent::kSunrise, pole, around).has_value() ? 1 : 0;
      sunsets += FindSunEvent(SunEvent::kSunset, pole, around).has_value() ? 1 : 0;
    }
    EXPECT_EQ(sunrises, latitude > 0.0 ? 1 : 0);
    EXPECT_EQ(sunsets, latitude > 0.0 ? 0 : 1);
  }
}

// Whatever the search samples, it must agree with a watch through the whole day.
// Hard case 24.
TEST(SunEvents, AroundTheMidnightSunNothingIsMissedOrInvented) {
  const GeodeticPosition place = PlaceFromDegrees(69.65, 0.0, 0.0);
  const double target = SeaHorizonFrom(0.0).true_elevation_rad;
  int days_with = 0;
  for (int day = 0; day < 10; ++day) {
    const UtcInstant midnight = AddSeconds(ParseInstant("2026-05-12T00:00:00Z"), 86400.0 * day);
    const auto above = [&](double time_s) {
      const SunPosition sun = SunAt(place, AddSeconds(midnight, time_s));
      return sun.elevation_rad + sun.angular_radius_rad > target;
    };
    bool rises = false;
    bool sets = false;
    bool was_above = above(0.0);
    for (double time_s = 60.0; time_s <= 86400.0; time_s += 60.0) {
      const bool is_above = above(time_s);
      rises = rises || (is_above && !was_above);
      sets = sets || (!is_above && was_above);
      was_above = is_above;
    }
    const UtcInstant noon = AddSeconds(midnight, 43200.0);
    EXPECT_EQ(FindSunEvent(SunEvent::kSunrise, place, noon).has_value(), rises) << day;
    EXPECT_EQ(FindSunEvent(SunEvent::kSunset, place, noon).has_value(), sets) << day;
    days_with += rises ? 1 : 0;
  }
  EXPECT_GT(days_with, 0);
  EXPECT_LT(days_with, 10) << "the midnight sun begins within these days";
}

// Hard case 27.
TEST(SunEvents, Longitudes180AndMinus180AreIdentical) {
  const UtcInstant around = ParseInstant("2026-06-21T12:00:00Z");
  for (const SunEvent event : kInOrder) {
    const auto east = FindSunEvent(event, PlaceFromDegrees(-16.5, 180.0, 0.0), around);
    EXPECT_EQ(east, FindSunEvent(event, PlaceFromDegrees(-16.5, -180.0, 0.0), around));
    EXPECT_EQ(east, FindSunEvent(event, {-16.5 * kRadiansPerDegree, -kPi, 0.0}, around));
  }
}

TEST(SunEvents, NoonsAreADayApartUpToTheEquationOfTime) {
  const GeodeticPosition place = PlaceFromDegrees(51.48, 0.0, 0.0);
  double earliest_s = 86400.0;
  double latest_s = 0.0;
  for (int day = 0; day < 365; day += 5) {
    const UtcInstant around = AddSeconds(ParseInstant("2026-01-01T12:00:00Z"), 86400.0 * day);
    const UtcInstant noon = FindSunEvent(SunEvent::kNoon, place, around).value();
    EXPECT_EQ(noon.modified_julian_day, around.modified_julian_day);
    earliest_s = std::min(earliest_s, noon.second_of_day);
    latest_s = std::max(latest_s, noon.second_of_day);
  }
  EXPECT_NEAR((earliest_s - 43200.0) / 60.0, -16.4, 0.1) << "equation of time in early November";
  EXPECT_NEAR((latest_s - 43200.0) / 60.0, 14.2, 0.1) << "and in February";
}

TEST(SunEvents, NamesAreThoseOfTheCommandLine) {
  EXPECT_EQ(SunEventFromName("noon"), SunEvent::kNoon);
  EXPECT_EQ(SunEventFromName("sunrise"), SunEvent::kSunrise);
  EXPECT_EQ(SunEventFromName("sunset"), SunEvent::kSunset);
  EXPECT_EQ(SunEventFromName("civil-dawn"), SunEvent::kCivilDawn);
  EXPECT_EQ(SunEventFromName("civil-dusk"), SunEvent::kCivilDusk);
  EXPECT_EQ(SunEventFromName("nautical-dawn"), SunEvent::kNauticalDawn);
  EXPECT_EQ(SunEventFromName("nautical-dusk"), SunEvent::kNauticalDusk);
  EXPECT_EQ(SunEventFromName("astronomical-dawn"), SunEvent::kAstronomicalDawn);
  EXPECT_EQ(SunEventFromName("astronomical-dusk"), SunEvent::kAstronomicalDusk);
  EXPECT_EQ(SunEventFromName("Noon"), std::nullopt);
  EXPECT_EQ(SunEventFromName("moonrise"), std::nullopt);
}

}  // namespace
}  // namespace alpenglow::atmosphere
