// SPDX-License-Identifier: MIT
#include "viewer/flight/clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"

namespace alpenglow::viewer {
namespace {

const GeodeticPosition kZurich = PlaceFromDegrees(47.4582, 8.5555, 432.0);

SceneClock ClockAt(const char* utc) { return SceneClock(ParseInstant(utc)); }
std::string Shows(const SceneClock& clock) { return FormatUtc(clock.now()); }

TEST(Clock, RatesStepThroughRealTimeAndStandstill) {
  EXPECT_EQ(SteppedTimeRate(1.0, 1), 10.0);
  EXPECT_EQ(SteppedTimeRate(1.0, -1), 0.0);
  EXPECT_EQ(SteppedTimeRate(0.0, -1), -1.0);
  EXPECT_EQ(SteppedTimeRate(3600.0, 1), 3600.0);
  EXPECT_EQ(SteppedTimeRate(-3600.0, -1), -3600.0);
}

TEST(Clock, AFrameOfASecondShowsAsMuchAsSixtyOfASixtieth) {
  SceneClock slow = ClockAt("2026-06-21T04:00:00Z");
  SceneClock fast = slow;
  slow.SetRate(60.0);
  fast.SetRate(60.0);
  slow.Advance(1.0);
  for (int i = 0; i < 60; ++i) fast.Advance(1.0 / 60.0);
  EXPECT_EQ(Shows(slow), "2026-06-21T04:01:00Z");
  EXPECT_NEAR(SecondsBetween(slow.now(), fast.now()), 0.0, 1e-9) << "rounding of 60 sums";
}

TEST(Clock, PausedItStandsAndItsHandsCanBeMoved) {
  SceneClock clock = ClockAt("2026-06-21T04:00:00Z");
  clock.SetRate(600.0);
  clock.Pause(true);
  clock.Advance(100.0);
  EXPECT_EQ(Shows(clock), "2026-06-21T04:00:00Z");
  EXPECT_EQ(clock.rate(), 600.0) << "kept for when it runs again";
  clock.Shift(-60.0);
  EXPECT_EQ(Shows(clock), "2026-06-21T03:59:00Z");
  clock.Pause(false);
  clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2026-06-21T04:09:00Z");
}

TEST(Clock, BackwardsItRunsAsFastAsForwards) {
  SceneClock clock = ClockAt("2026-01-01T00:00:10Z");
  clock.SetRate(-3600.0);
  clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2025-12-31T23:00:10Z");
  EXPECT_THROW(clock.SetRate(3601.0), InputError);
  EXPECT_THROW(clock.SetRate(std::nan("")), InputError);
}

// Hard case 25.
TEST(Clock, OverALeapSecondItCountsAsClocksDo) {
  SceneClock clock = ClockAt("2016-12-31T23:59:50Z");
  for (int i = 0; i < 20; ++i) clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2017-01-01T00:00:10Z");
  clock.SetRate(-60.0);
  clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2016-12-31T23:59:10Z");
}

TEST(Clock, StopsAtTheEndsOfTheYearsThatItKnows) {
  SceneClock clock = ClockAt("2100-12-31T23:00:00Z");
  clock.Shift(1e7);
  EXPECT_EQ(Shows(clock), "2100-12-31T23:59:59Z");
  clock.Shift(-1e11);
  EXPECT_EQ(Shows(clock), "1900-01-01T00:00:00Z");
}

TEST(Clock, JumpsToTheNextSunriseAndNeverToTheSameAgain) {
  SceneClock clock = ClockAt("2026-06-21T12:00:00Z");
  for (int day = 22; day < 25; ++day) {
    ASSERT_TRUE(clock.JumpToNext(SkyEvent::kSunrise, kZurich));
    const UtcInstant expected = *FindSunEvent(
        SunEvent::kSunrise, kZurich, ParseInstant("2026-06-" + std::to_string(day) + "T12:00:00Z"));
    EXPECT_NEAR(SecondsBetween(expected, clock.now()), 0.0, 0.2)
        << "both searches are within 0.1 s";
  }
}

TEST(Clock, TheEventsOfADayComeInTheirOrder) {
  SceneClock clock = ClockAt("2026-03-20T00:00:00Z");
  UtcInstant before = clock.now();
  for (const SkyEvent event :
       {SkyEvent::kDawn, SkyEvent::kSunrise, SkyEvent::kNoon, SkyEvent::kSunset, SkyEvent::kDusk}) {
    ASSERT_TRUE(clock.JumpToNext(event, kZurich)) << NameOf(event);
    const double passed_s = SecondsBetween(before, clock.now());
    EXPECT_GT(passed_s, 1000.0) << NameOf(event) << " is twilights and half days later";
    EXPECT_LT(passed_s, 7.0 * 3600.0) << NameOf(event);
    before = clock.now();
  }
}

TEST(Clock, InThePolarNightTheNextSunriseIsWeeksAwayAndAtThePoleMonths) {
  SceneClock clock = ClockAt("2026-12-01T12:00:00Z");
  const GeodeticPosition tromso = PlaceFromDegrees(69.6492, 18.9553, 0.0);
  ASSERT_TRUE(clock.JumpToNext(SkyEvent::kSunrise, tromso));
  // The sun comes back to a sea horizon at 69.65 degrees north in the middle of January.
  EXPECT_EQ(Shows(clock).substr(0, 8), "2027-01-");
}

TEST(Clock, NoDayIsPassedOverOnTheWayToTheNextEvent) {
  struct Case {
    double latitude, height_m;
    const char* start;
  };
  for (const auto& [latitude, height_m, start] :
       {Case{89.9, 0.0, "2026-09-10T12:00:00Z"}, Case{78.0, 12000.0, "2026-08-15T12:00:00Z"},
        Case{78.0, 0.0, "2026-02-05T12:00:00Z"}, Case{66.0, 0.0, "2026-06-10T12:00:00Z"},
        Case{-67.0, 3000.0, "2026-12-25T12:00:00Z"}, Case{0.0, 0.0, "2026-12-25T12:00:00Z"}}) {
    const GeodeticPosition place = PlaceFromDegrees(latitude, 15.0, height_m);
    SceneClock clock = ClockAt(start);
    // The reference solution searches every day.
    std::optional<UtcInstant> expected;
    for (int day = 0; !expected && day < 60; ++day) {
      expected = FindSunEvent(SunEvent::kSunset, place, AddSeconds(clock.now(), day * 86400.0));
      if (expected && SecondsBetween(clock.now(), *expected) < 1.0) expected.reset();
    }
    ASSERT_TRUE(expected) << latitude << " " << start;
    ASSERT_TRUE(clock.JumpToNext(SkyEvent::kSunset, place)) << latitude << " " << start;
    EXPECT_NEAR(SecondsBetween(*expected, clock.now()), 0.0, 0.2) << latitude << " " << start;
  }
}

TEST(Clock, EventsOfTheMoonAreThoseOfItsEphemeris) {
  SceneClock clock = ClockAt("2026-06-21T12:00:00Z");
  for (const auto& [event, next] : {std::pair{SkyEvent::kMoonset, &NextMoonset},
                                    std::pair{SkyEvent::kMoonrise, &NextMoonrise}}) {
    const UtcInstant expected = next(kZurich, clock.now()).value();
    ASSERT_TRUE(clock.JumpToNext(event, kZurich));
    EXPECT_EQ(SecondsBetween(expected, clock.now()), 0.0) << NameOf(event);
  }
}

TEST(Clock, TypedTimesAreUtcWithAZAndLocalWithout) {
  SceneClock clock = ClockAt("2026-06-21T23:30:00Z");
  clock.Type("2026-01-02T03:04:05Z", kZurich, "Europe/Zurich");
  EXPECT_EQ(Shows(clock), "2026-01-02T03:04:05Z");
  clock.Type("2026-07-02T03:04:05", kZurich, "Europe/Zurich");
  EXPECT_EQ(Shows(clock), "2026-07-02T01:04:05Z") << "summer time";
  clock.Type("18:30", kZurich, "Europe/Zurich");
  EXPECT_EQ(Shows(clock), "2026-07-02T16:30:00Z") << "of the same day";
  clock.Type("06:07:08", kZurich, "Asia/Tokyo");
  EXPECT_EQ(Shows(clock), "2026-07-02T21:07:08Z") << "at 16:30 UTC Tokyo already has the 3rd";
  clock.Type("sunset-20m", kZurich, "Europe/Zurich");
  const UtcInstant sunset = *FindSunEvent(SunEvent::kSunset, kZurich, clock.now());
  EXPECT_NEAR(SecondsBetween(clock.now(), sunset), 1200.0, 0.2);
  EXPECT_THROW(clock.Type("25:00", kZurich, "Europe/Zurich"), InputError);
  EXPECT_THROW(clock.Type("sunsat", kZurich, "Europe/Zurich"), InputError);
  EXPECT_THROW(clock.Type("", kZurich, "Europe/Zurich"), InputError);
}

}  // namespace
}  // namespace alpenglow::viewer
