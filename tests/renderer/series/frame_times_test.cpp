// SPDX-License-Identifier: MIT
#include "renderer/series/frame_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow {
namespace {

using testing::HasSubstr;

EventDay Fuji() {
  const GeodeticPosition place = PlaceFromDegrees(35.3606, 138.7274, 0.0);
  return {place, "Asia/Tokyo", DayFromText("2026-06-21", place, "Asia/Tokyo")};
}

EventDay Tromso(const char* date) {
  const GeodeticPosition place = PlaceFromDegrees(69.65, 18.96, 0.0);
  return {place, std::nullopt, DayFromText(date, place, std::nullopt)};
}

using tests::FaultOf;

TEST(FrameTimes, AnInstantIsReadAsItStands) {
  EXPECT_EQ(FormatUtc(InstantFromText("2026-06-21T04:00:00Z", Fuji())), "2026-06-21T04:00:00Z");
  EXPECT_EQ(FormatUtc(InstantFromText("2026-06-21T13:00:00", Fuji())), "2026-06-21T04:00:00Z")
      << "without Z or offset in the zone of the place";
}

TEST(FrameTimes, AnEventIsFoundOnTheLocalDay) {
  const EventDay day = Fuji();
  const UtcInstant sunrise = InstantFromText("sunrise", day);
  EXPECT_EQ(FormatInZone(sunrise, "Asia/Tokyo").substr(0, 14), "2026-06-21T04:")
      << "the sun rises over Fuji in midsummer between 4 and 5 o'clock";
  const UtcInstant sunset = InstantFromText("sunset", day);
  EXPECT_EQ(FormatInZone(sunset, "Asia/Tokyo").substr(0, 14), "2026-06-21T19:");
}

TEST(FrameTimes, OffsetsMoveTheEvent) {
  const EventDay day = Fuji();
  const UtcInstant dusk = InstantFromText("civil-dusk", day);
  EXPECT_NEAR(SecondsBetween(dusk, InstantFromText("civil-dusk+20m", day)), 1200.0, 1e-6);
  EXPECT_NEAR(SecondsBetween(dusk, InstantFromText("civil-dusk-1h30m", day)), -5400.0, 1e-6);
  EXPECT_NEAR(SecondsBetween(InstantFromText("noon", day), InstantFromText("noon-90s", day)), -90.0,
              1e-6);
}

TEST(FrameTimes, UnknownEventsNameTheNearest) {
  EXPECT_THAT(FaultOf([] { return InstantFromText("sunris-1h", Fuji()); }),
              HasSubstr("unknown event \"sunris\"; did you mean sunrise?"));
  EXPECT_THAT(FaultOf([] { return InstantFromText("teatime", Fuji()); }),
              HasSubstr("unknown event"));
  for (const char* text : {"", "sunrise+", "sunrise-1x", "2024-02-30T00:00:00Z", "sunrise 1h"}) {
    EXPECT_NE(FaultOf([&] { return InstantFromText(text, Fuji()); }), "no fault") << text;
  }
}

TEST(FrameTimes, AnEventNeedsADay) {
  EventDay day = Fuji();
  day.around.reset();
  EXPECT_THAT(FaultOf([&] { return InstantFromText("sunrise", day); }), HasSubstr("which day"));
}

// Hard case 24.
TEST(FrameTimes, PolarDayAndNightHaveNoSunrise) {
  EXPECT_THAT(FaultOf([] { return InstantFromText("sunrise", Tromso("2026-06-21")); }),
              HasSubstr("there is no sunrise on 2026-06-21"));
  EXPECT_THAT(FaultOf([] { return InstantFromText("sunset+5m", Tromso("2026-12-21")); }),
              HasSubstr("there is no sunset on 2026-12-21"));
  EXPECT_EQ(FaultOf([] { return InstantFromText("noon", Tromso("2026-12-21")); }), "no fault");
}

TEST(FrameTimes, EveryStepsUpToTheEnd) {
  const std::vector<Frame> frames = FramesFromTimes(
      {{}, "2026-06-21T04:00:00Z", "2026-06-21T05:00:00Z", "10m", std::nullopt}, Fuji());
  ASSERT_EQ(frames.size(), 7U) << "both ends belong to the series";
  EXPECT_EQ(frames.front().number, 0);
  EXPECT_EQ(frames.back().number, 6);
  EXPECT_EQ(FormatUtc(frames.back().instant), "2026-06-21T05:00:00Z");
  EXPECT_EQ(FramesFromTimes(
                {{}, "2026-06-21T04:00:00Z", "2026-06-21T05:00:00Z", "25m", std::nullopt}, Fuji())
                .size(),
            3U);
}

TEST(FrameTimes, CountSpreadsEvenlyBetweenEvents) {
  const std::vector<Frame> frames =
      FramesFromTimes({{}, "sunrise-1h", "sunset+1h", std::nullopt, 5}, Fuji());
  ASSERT_EQ(frames.size(), 5U);
  const double step = SecondsBetween(frames[0].instant, frames[1].instant);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_NEAR(SecondsBetween(frames[i - 1].instant, frames[i].instant), step, 1e-6);
  }
  EXPECT_EQ(FramesFromTimes({{}, "sunrise", "sunset", std::nullopt, 1}, Fuji()).size(), 1U);
}

TEST(FrameTimes, SunsetToSunriseIsANight) {
  const std::vector<Frame> frames =
      FramesFromTimes({{}, "sunset", "sunrise", std::nullopt, 2}, Fuji());
  const double hours = SecondsBetween(frames[0].instant, frames[1].instant) / 3600.0;
  EXPECT_NEAR(hours, 9.4, 0.2) << "a midsummer night at latitude 35";
}

TEST(FrameTimes, AnInstantSaysTheDayOfTheEventAtTheOtherEnd) {
  EventDay day = Fuji();
  day.around.reset();
  const std::vector<Frame> morning =
      FramesFromTimes({{}, "2026-06-21T03:00:00", "sunrise", std::nullopt, 2}, day);
  EXPECT_EQ(FormatInZone(morning[1].instant, "Asia/Tokyo").substr(0, 14), "2026-06-21T04:");
  const std::vector<Frame> evening =
      FramesFromTimes({{}, "sunset", "2026-06-21T23:00:00", std::nullopt, 2}, day);
  EXPECT_EQ(FormatInZone(evening[0].instant, "Asia/Tokyo").substr(0, 14), "2026-06-21T19:");
}

TEST(FrameTimes, AtMayBeGivenSeveralTimes) {
  const std::vector<Frame> frames =
      FramesFromTimes({{"noon", "2026-06-21T00:00:00Z"}, {}, {}, {}, {}}, Fuji());
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(FormatUtc(frames[1].instant), "2026-06-21T00:00:00Z");
}

TEST(FrameTimes, SeriesThatAreNoneAreRefused) {
  const std::string early = "2026-06-21T04:00:00Z";
  const std::string late = "2026-06-21T05:00:00Z";
  const std::vector<TimesText> bad = {{{}, early, {}, "1m", {}},        {{}, late, early, "1m", {}},
                                      {{}, early, late, {}, {}},        {{}, early, late, "0s", {}},
                                      {{}, early, late, "-5m", {}},     {{}, early, late, {}, 0},
                                      {{}, early, late, "0.0001s", {}}, {{}, {}, {}, {}, {}}};
  for (const TimesText& times : bad) {
    EXPECT_NE(FaultOf([&] { return FramesFromTimes(times, Fuji()); }), "no fault")
        << times.every.value_or("-");
  }
}

TEST(FrameTimes, FramesAreSelectedByRanges) {
  const std::vector<Frame> frames =
      FramesFromTimes({{}, "sunrise", "sunset", std::nullopt, 10}, Fuji());
  std::vector<int> numbers;
  for (const Frame& frame : SelectFrames(frames, "0,2-4,9,3")) numbers.push_back(frame.number);
  EXPECT_EQ(numbers, (std::vector<int>{0, 2, 3, 4, 9}));
  for (const char* bad : {"", "10", "3-2", "a", "1-", "-3", "1,,2", "1-2-3", "1 2", "9999999999"}) {
    EXPECT_NE(FaultOf([&] { return SelectFrames(frames, bad); }), "no fault") << bad;
  }
}

TEST(FrameTimes, TheDayOfAPlaceWithoutZoneIsThatOfItsMeridian) {
  const GeodeticPosition fiji = PlaceFromDegrees(-17.7, 178.0, 0.0);
  EXPECT_EQ(FormatUtc(DayFromText("2026-06-21", fiji, std::nullopt)), "2026-06-21T00:08:00Z");
  EXPECT_THROW((void)DayFromText("2026-6-21", fiji, std::nullopt), InputError);
  EXPECT_THROW((void)DayFromText("2026-02-30", fiji, std::nullopt), InputError);
}

}  // namespace
}  // namespace alpenglow
