// SPDX-License-Identifier: MIT
#include "renderer/series/frame_times.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/fixtures/event_days.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using tests::FaultOf;
using tests::Fuji;
using tests::Tromso;

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

/// What clocks in the zone show at the frames, "2026-03-27T12:00".
std::vector<std::string> ClocksOf(const TimesText& times, const EventDay& day) {
  std::vector<std::string> clocks;
  for (const Frame& frame : FramesFromTimes(times, day))
    clocks.push_back(FormatInZone(frame.instant, *day.zone).substr(0, 16));
  return clocks;
}
EventDay Zurich(const char* date) {
  EventDay day{PlaceFromDegrees(47.0, 8.0, 0.0), "Europe/Zurich", {}};
  day.around = DayFromText(date, day);
  return day;
}

TEST(FrameTimes, ADayOfEveryIsADayOfTheCalendar) {
  // Clocks are set on 2026-03-29 and 2026-10-25.
  EXPECT_EQ(ClocksOf({{}, "12:00", "2026-03-31 12:00", "1d", {}}, Zurich("2026-03-27")),
            (std::vector<std::string>{"2026-03-27T12:00", "2026-03-28T12:00", "2026-03-29T12:00",
                                      "2026-03-30T12:00", "2026-03-31T12:00"}));
  EXPECT_EQ(ClocksOf({{}, "00:30", "2026-10-28 00:30", "2d", {}}, Zurich("2026-10-24")),
            (std::vector<std::string>{"2026-10-24T00:30", "2026-10-26T00:30", "2026-10-28T00:30"}));
  EXPECT_EQ(ClocksOf({{}, "12:00", "2026-03-30 12:00", "24h", {}}, Zurich("2026-03-28")),
            (std::vector<std::string>{"2026-03-28T12:00", "2026-03-29T13:00"}))
      << "24 hours are 24 hours";
}

TEST(FrameTimes, AClockTimeThatADayLacksKeepsTheOffsetBefore) {
  EXPECT_EQ(ClocksOf({{}, "02:30", "2026-03-30 12:00", "1d", {}}, Zurich("2026-03-28")),
            (std::vector<std::string>{"2026-03-28T02:30", "2026-03-29T03:30", "2026-03-30T02:30"}));
  const std::vector<Frame> twice =
      FramesFromTimes({{}, "02:30", "2026-10-26 12:00", "1d", {}}, Zurich("2026-10-24"));
  ASSERT_EQ(twice.size(), 3U);
  EXPECT_EQ(FormatUtc(twice[1].instant), "2026-10-25T00:30:00Z") << "the first of the two";
  EXPECT_EQ(FormatUtc(twice[2].instant), "2026-10-26T01:30:00Z");
}

TEST(FrameTimes, ARangeOfClockTimesRollsOverMidnight) {
  EXPECT_EQ(ClocksOf({{}, "22:00", "02:00", "2h", {}}, Zurich("2026-06-21")),
            (std::vector<std::string>{"2026-06-21T22:00", "2026-06-22T00:00", "2026-06-22T02:00"}));
  EXPECT_EQ(ClocksOf({{}, "2026-10-25 00:10", "00:05", {}, 2}, Zurich("2026-06-21")).back(),
            "2026-10-26T00:05")
      << "the day has 25 hours";
  EXPECT_EQ(ClocksOf({{}, "sunset", "02:00", {}, 2}, Zurich("2026-06-21")).back(),
            "2026-06-22T02:00");
}

TEST(FrameTimes, EachDayHasItsOwnSunrise) {
  const std::vector<Frame> frames =
      FramesFromTimes({{}, "sunrise-10m", "2027-06-20", "1d", std::nullopt}, Fuji());
  ASSERT_EQ(frames.size(), 365U) << "both days belong to the series";
  for (const Frame& frame : frames) {
    EventDay day = Fuji();
    day.around = AddSeconds(*day.around, frame.number * 86400.0);
    EXPECT_EQ(frame.instant, InstantFromText("sunrise-10m", day)) << frame.number;
  }
}

TEST(FrameTimes, AWrittenFirstDayCountsAsTheDayOfTheEvent) {
  EventDay day = Fuji();
  day.around.reset();
  const std::vector<Frame> frames =
      FramesFromTimes({{}, "2026-06-21 sunset", "2026-06-27", "2d", std::nullopt}, day);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(FormatUtc(frames[3].instant), FormatUtc(InstantFromText("2026-06-27 sunset", Fuji())));
}

TEST(FrameTimes, DaysWithoutTheEventHaveNoFrame) {
  const std::vector<Frame> year =
      FramesFromTimes({{}, "sunrise", "2026-12-31", "1d", std::nullopt}, Tromso("2026-01-01"));
  // Midnight sun from May 18th to July 26th, polar night from November 27th to January 15th: 70 and
  // 50 days; days on which refraction decides are left to the tolerance.
  EXPECT_NEAR(static_cast<double>(year.size()), 365.0 - 70.0 - 50.0, 6.0);
  EXPECT_EQ(year.back().number, static_cast<int>(year.size()) - 1) << "numbered without gaps";
  EXPECT_NE(FaultOf([] {
              return FramesFromTimes({{}, "sunrise", "2026-06-25", "1d", {}}, Tromso("2026-06-21"));
            }),
            "no fault")
      << "a series without a frame is none";
}

}  // namespace
}  // namespace alpenglow::renderer
