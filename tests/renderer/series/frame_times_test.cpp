// SPDX-License-Identifier: MIT
// Times as users write them, and the times of the frames of a series.
#include "renderer/series/frame_times.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/astronomy/time_text.h"
#include "atmosphere/base/error.h"
#include "tests/fixtures/event_days.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using testing::Not;
using tests::FaultOf;
using tests::Fuji;
using tests::Tromso;

/// Returns the instant of a text on midsummer at Mount Fuji.
UtcTime At(const std::string& text) { return InstantFromText(text, Fuji()); }
std::string UtcAt(const std::string& text) { return FormatUtc(At(text)); }
std::string FaultAt(const std::string& text, const EventDay& day = Fuji()) {
  return FaultOf([&] { return InstantFromText(text, day); });
}

TEST(TimeText, InstantsAndClockTimesAreThoseOfThePlace) {
  for (const auto& [text, utc] :
       {std::pair{"2026-06-21T04:00:00Z", "2026-06-21T04:00:00Z"},
        {"2026-06-21T13:00:00", "2026-06-21T04:00:00Z"},  // without Z or offset in the place's zone
        {"18:30", "2026-06-21T09:30:00Z"},
        {"18:30:15", "2026-06-21T09:30:15Z"},
        {"18:30Z", "2026-06-21T18:30:00Z"},
        {"2026-06-22 18:30", "2026-06-22T09:30:00Z"},
        {"1830", "2026-06-21T09:30:00Z"},  // four digits are a clock time
        {"0005Z", "2026-06-21T00:05:00Z"},
        {"2026-06-22 1830", "2026-06-22T09:30:00Z"}})
    EXPECT_EQ(UtcAt(text), utc) << text;
  EXPECT_TRUE(IsClockTime("1830"));
  EventDay day = Fuji();
  day.zone.reset();
  EXPECT_THAT(FaultAt("18:30", day), HasSubstr("time zone"));
  day.around.reset();
  EXPECT_THAT(FaultAt("18:30Z", day), HasSubstr("which day"));
}

TEST(TimeText, EventsAreFoundOnTheLocalDayAndMovedByOffsets) {
  EXPECT_EQ(FormatInZone(At("sunrise"), "Asia/Tokyo").substr(0, 14), "2026-06-21T04:")
      << "the sun rises over Fuji in midsummer between 4 and 5 o'clock";
  EXPECT_EQ(FormatInZone(At("sunset"), "Asia/Tokyo").substr(0, 14), "2026-06-21T19:");
  const UtcTime dusk = At("civil-dusk");
  EXPECT_NEAR(SecondsBetween(dusk, At("civil-dusk+20m")), 1200.0, 1e-6);
  EXPECT_NEAR(SecondsBetween(dusk, At("civil-dusk-1h30m")), -5400.0, 1e-6);
  EXPECT_NEAR(SecondsBetween(At("noon"), At("noon-90s")), -90.0, 1e-6);
  EventDay day = Fuji();
  day.around.reset();
  EXPECT_THAT(FaultAt("sunrise", day), HasSubstr("which day"));
}

TEST(TimeText, UnknownTextsNameTheNearestKnown) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"sunris-1h", "unknown event \"sunris\"; did you mean sunrise?"},
      {"teatime", "unknown event"},
      {"6pm", "did you mean 18:00?"},
      {"12 AM", "did you mean 00:00?"},
      {"6:30 p.m.", "did you mean 18:30?"},
      {"9:30", "did you mean 09:30?"},
      {"18h30", "did you mean 18:30?"},
      {"2026-06-21 6pm", "did you mean 18:00?"},
      {"tomorrow 6pm", "did you mean 18:00?"},
      {"2026-06-21T18:00:00+0200", "the offset \"+0200\" is written +02:00"},
      {"18:00-03", "the offset \"-03\" is written -03:00"},
      {"+0200", "an offset follows a time"},
      {"-0044-03-15T12:00:00Z", "the year must be four digits and lie in [1900, 2100]"},
      {"+12026-06-21T12:00:00Z", "the year must be four digits and lie in [1900, 2100]"},
      {"12026-06-21T12:00:00Z", "the year must be four digits and lie in [1900, 2100]"},
      {"0044-03-15T12:00:00Z", "the year must be four digits and lie in [1900, 2100]"},
      {"2101-01-01T12:00:00Z", "the year must be four digits and lie in [1900, 2100]"},
      {"-0044-03-15", "the year must be four digits and lie in [1900, 2100]"}};
  for (const auto& [text, message] : cases) EXPECT_THAT(FaultAt(text), HasSubstr(message)) << text;
  for (const char* text :
       {"", "sunrise+", "sunrise-1x", "2024-02-30T00:00:00Z", "sunrise 1h", "2460", "183", "18300"})
    EXPECT_NE(FaultAt(text), "no fault") << text;
}

TEST(TimeText, ContactsOfAnEclipseAreEvents) {
  EventDay day{Place{42.3439, -3.6969, 860.0}, "Europe/Madrid", {}};  // Burgos
  day.around = DayFromText("2026-08-12", day);
  const char* before = "sunrise";
  for (const char* event : {"first-contact", "second-contact", "eclipse-maximum", "third-contact",
                            "last-contact", "sunset"}) {
    EXPECT_GT(SecondsBetween(InstantFromText(before, day), InstantFromText(event, day)), 0.0)
        << event;
    before = event;
  }
  EXPECT_NEAR(
      SecondsBetween(InstantFromText("second-contact", day), InstantFromText("third-contact", day)),
      104.0, 1.0)
      << "of totality, in all almanacs";
  const EventDay madrid{Place{40.4168, -3.7038, 660.0}, "Europe/Madrid", day.around};
  EXPECT_THAT(FaultAt("second-contact", madrid), HasSubstr("no such eclipse of the sun"))
      << "partial";
  EXPECT_THAT(FaultAt("first-contact"), HasSubstr("no such eclipse of the sun"));
}

// Hard case 24.
TEST(TimeText, PolarDayAndNightHaveNoSunrise) {
  struct Case {
    const char *event, *date, *says;
    const char* never = "\n";
  };
  for (const Case& one : {Case{"sunrise", "2026-06-21", "polar day"},
                          {"sunset", "2026-06-21", "there is no sunset on 2026-06-21", "night"},
                          {"sunset+5m", "2026-12-21", "polar night"},
                          {"sunrise", "2026-12-21", "polar night", "polar day"},
                          {"astronomical-dusk", "2026-05-10", "the night is light"}})
    EXPECT_THAT(FaultAt(one.event, Tromso(one.date)),
                AllOf(HasSubstr(one.says), Not(HasSubstr(one.never))));
  EXPECT_EQ(FaultAt("noon", Tromso("2026-12-21")), "no fault");
}

TEST(TimeText, TheDayOfAPlaceWithoutZoneIsThatOfItsMeridian) {
  const EventDay fiji{Place{-17.7, 178.0, 0.0}, {}, {}};
  EXPECT_EQ(FormatUtc(DayFromText("2026-06-21", fiji)), "2026-06-21T00:08:00Z");
  EXPECT_THROW((void)DayFromText("2026-6-21", fiji), InputError);
  EXPECT_THROW((void)DayFromText("2026-02-30", fiji), InputError);
}

/// Returns a day whose machine's clock is at 23:30 of June 21st in Tokyo.
EventDay LateOnTheDay() {
  EventDay day = Fuji();
  day.around.reset();
  day.now = ParseInstant("2026-06-21T23:30:00+09:00");
  return day;
}

TEST(TimeText, NowIsTheTimeOfTheClock) {
  EXPECT_EQ(InstantFromText("now", LateOnTheDay()), LateOnTheDay().now);
  EXPECT_EQ(FormatUtc(InstantFromText("now+1h30m", LateOnTheDay())), "2026-06-21T16:00:00Z");
  const EventDay without_clock;
  EXPECT_LT(std::abs(SecondsBetween(without_clock.now, Now())), 60.0);
}

TEST(TimeText, TodayAndTomorrowAreDaysOfThePlace) {
  const EventDay day = LateOnTheDay();
  EXPECT_EQ(DateAt(DayFromText("today", day), day), "2026-06-21");
  EXPECT_EQ(DateAt(DayFromText("tomorrow", day), day), "2026-06-22");
  EXPECT_EQ(DateAt(DayFromText("yesterday", day), day), "2026-06-20");
  EXPECT_EQ(FormatUtc(InstantFromText("tomorrow 18:30", day)), "2026-06-22T09:30:00Z");
  EXPECT_EQ(InstantFromText("tomorrow sunrise-5m", day),
            InstantFromText("2026-06-22 sunrise-5m", day));
  EXPECT_EQ(InstantFromText("tomorrow", day), InstantFromText("tomorrow noon", day));
  EXPECT_EQ(InstantFromText("tomorrow 0600", day), InstantFromText("tomorrow 06:00", day));
  EXPECT_THAT(FaultAt("2026-06-22", day), HasSubstr("what time"))
      << "a date may be meant to begin or to end a series";
}

TEST(TimeText, MidnightIsWhereTheSunIsLowest) {
  for (const double latitude : {0.0, 46.5, 69.0}) {
    EventDay day = Fuji();
    day.place.latitude_deg = latitude;
    const UtcTime midnight = InstantFromText("midnight", day);
    const double lowest = TrueSunAt(day.place, midnight).elevation_rad();
    for (const double seconds : {-600.0, 600.0})
      EXPECT_LT(lowest, TrueSunAt(day.place, AddSeconds(midnight, seconds)).elevation_rad())
          << latitude;
    EXPECT_GT(SecondsBetween(InstantFromText("noon", day), midnight), 0.0) << "it ends the day";
    EXPECT_EQ(InstantFromText("midnight+20m", day), AddSeconds(midnight, 1200.0));
  }
}

TEST(TimeText, TomorrowIsTheNextDayWhenClocksAreChanged) {
  EventDay zurich{Place{47.4, 8.5, 400.0}, "Europe/Zurich", {}};
  for (const char* now : {"2026-03-28T23:59:00+01:00", "2026-03-28T00:01:00+01:00"}) {
    zurich.now = ParseInstant(now);
    EXPECT_EQ(DateAt(DayFromText("tomorrow", zurich), zurich), "2026-03-29") << now;
  }
}

TEST(TimeText, TheMoonHasEventsOfTheDay) {
  const EventDay day = Fuji();
  const UtcTime rise = InstantFromText("moonrise", day);
  const UtcTime next = *NextMoonrise(day.place, ParseInstant("2026-06-21T00:00:00+09:00"));
  EXPECT_NEAR(SecondsBetween(next, rise), 0.0, 0.1) << "the error of its search";
  EXPECT_NEAR(SecondsBetween(rise, InstantFromText("moonrise+20m", day)), 1200.0, 1e-6);
  const UtcTime transit = InstantFromText("moon-transit", day);
  const double before = TrueMoonAt(day.place, AddSeconds(transit, -900.0)).elevation_rad();
  const double at = TrueMoonAt(day.place, transit).elevation_rad();
  const double after = TrueMoonAt(day.place, AddSeconds(transit, 900.0)).elevation_rad();
  EXPECT_GT(at, before);
  EXPECT_GT(at, after);
}

TEST(TimeText, ADayWithoutMoonriseNamesTheNextOne) {
  EventDay day = Fuji();
  int without = 0;
  for (int i = 0; i < 30; ++i) {
    day.around = AddSeconds(*Fuji().around, i * 86400.0);
    if (FindDailyEvent("moonrise", day)) continue;
    ++without;
    EXPECT_THAT(FaultAt("moonrise", day), HasSubstr("the next is at"));
  }
  EXPECT_EQ(without, 1) << "a moon of 29.5 days rises 28.5 times";
}

// Events on dates of mean solar time at sea level: latitude, longitude and date, then sunrise,
// noon, sunset, moonrise, transit and moonset of the moon as UTC.
//
// They are from libastro of XEphem (VSOP 87, ELP 2000-82 truncated by Moshier), upper limb at 34'
// under the horizon, through PyEphem 4.1.4.
constexpr const char* kAlmanac = R"(
51.4779 0.0 2026-03-20
  03-20T06:02:53 03-20T12:07:26 03-20T18:12:59 03-20T06:16:07 03-20T13:14:47 03-20T20:34:45
51.4779 0.0 2026-08-12
  08-12T04:40:45 08-12T12:05:03 08-12T19:28:16 08-12T03:56:05 08-12T11:53:53 08-12T19:28:53
35.6895 139.6917 2026-03-20
  03-19T20:45:36 03-20T02:48:46 03-20T08:52:31 03-19T21:06:09 03-20T03:36:49 03-20T10:18:37
35.6895 139.6917 2026-08-12
  08-11T19:57:28 08-12T02:46:21 08-12T09:34:41 08-11T18:54:51 08-12T02:13:45 08-12T09:21:25
-0.2167 -78.5 2026-03-20
  03-20T11:18:07 03-20T17:21:22 03-20T23:24:37 03-20T12:28:00 03-20T18:39:46 03-21T00:51:40
-0.2167 -78.5 2026-08-12
  08-12T11:15:52 08-12T17:19:01 08-12T23:22:10 08-12T11:07:07 08-12T17:19:35 08-12T23:31:49
-54.8 -68.3 2026-03-20
  03-20T10:34:29 03-20T16:40:34 03-20T22:45:31 03-20T12:50:36 03-20T17:57:32 03-20T22:47:48
-54.8 -68.3 2026-08-12
  08-12T12:00:20 08-12T16:38:13 08-12T21:16:51 08-12T12:11:20 08-12T16:37:16 08-12T21:18:22
69.65 18.96 2026-03-20
  03-20T04:43:53 03-20T10:51:36 03-20T17:01:30 03-20T04:08:58 03-20T11:56:19 03-20T20:42:52
69.65 18.96 2026-08-12
  08-12T01:29:25 08-12T10:49:13 08-12T20:04:52 08-11T23:10:18 08-12T10:35:11 08-12T19:59:01)";

// Almanacs round to the minute; sunrise is required within 10 s and moonrise within 60 s.
TEST(TimeText, SunAndMoonAreThoseOfAnAlmanac) {
  std::istringstream almanac(kAlmanac);
  double latitude = 0.0, longitude = 0.0;
  std::string date, utc;
  int days = 0;
  for (; almanac >> latitude >> longitude >> date; ++days) {
    EventDay day{CheckedPlace({latitude, longitude, 0.0}), {}, {}};
    day.around = DayFromText(date, day);
    for (const char* event : {"sunrise", "noon", "sunset", "moonrise", "moon-transit", "moonset"}) {
      ASSERT_TRUE(almanac >> utc);
      const auto instant = FindDailyEvent(event, day);
      ASSERT_TRUE(instant.has_value()) << latitude << ' ' << date << ' ' << event;
      const UtcTime expected = ParseInstant(fmt::format("2026-{}Z", utc));
      EXPECT_NEAR(SecondsBetween(expected, *instant), 0.0, event[0] == 'm' ? 60.0 : 10.0)
          << latitude << ' ' << date << ' ' << event;
    }
  }
  EXPECT_EQ(days, 10);
}

/// Returns the frames from one time to another, by step or count.
std::vector<Frame> Range(const std::string& from, const std::string& to,
                         std::optional<std::string> every, std::optional<int> count = {},
                         const EventDay& day = Fuji()) {
  return FramesFromTimes({{}, from, to, std::move(every), count}, day);
}

TEST(FrameTimes, EveryStepsUpToTheEnd) {
  const std::string from = "2026-06-21T04:00:00Z", to = "2026-06-21T05:00:00Z";
  const std::vector<Frame> frames = Range(from, to, "10m");
  ASSERT_EQ(frames.size(), 7U) << "both ends belong to the series";
  EXPECT_EQ(frames.front().number, 0);
  EXPECT_EQ(frames.back().number, 6);
  EXPECT_EQ(FormatUtc(frames.back().instant), to);
  EXPECT_EQ(Range(from, to, "25m").size(), 3U);
}

TEST(FrameTimes, CountSpreadsEvenlyBetweenEvents) {
  const std::vector<Frame> frames = Range("sunrise-1h", "sunset+1h", {}, 5);
  ASSERT_EQ(frames.size(), 5U);
  const double step = SecondsBetween(frames[0].instant, frames[1].instant);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_NEAR(SecondsBetween(frames[i - 1].instant, frames[i].instant), step, 1e-6);
  }
  EXPECT_EQ(Range("sunrise", "sunset", {}, 1).size(), 1U);
}

TEST(FrameTimes, SunsetToSunriseIsANight) {
  const std::vector<Frame> frames = Range("sunset", "sunrise", {}, 2);
  const double hours = SecondsBetween(frames[0].instant, frames[1].instant) / 3600.0;
  EXPECT_NEAR(hours, 9.4, 0.2) << "a midsummer night at latitude 35";
}

TEST(FrameTimes, AnInstantDefinesTheDayOfTheEventAtTheOtherEnd) {
  EventDay day = Fuji();
  day.around.reset();
  const std::vector<Frame> morning = Range("2026-06-21T03:00:00", "sunrise", {}, 2, day);
  EXPECT_EQ(FormatInZone(morning[1].instant, "Asia/Tokyo").substr(0, 14), "2026-06-21T04:");
  const std::vector<Frame> evening = Range("sunset", "2026-06-21T23:00:00", {}, 2, day);
  EXPECT_EQ(FormatInZone(evening[0].instant, "Asia/Tokyo").substr(0, 14), "2026-06-21T19:");
}

TEST(FrameTimes, AtMayBeGivenSeveralTimes) {
  const std::vector<Frame> frames =
      FramesFromTimes({{"noon", "2026-06-21T00:00:00Z"}, {}, {}, {}, {}}, Fuji());
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(FormatUtc(frames[1].instant), "2026-06-21T00:00:00Z");
}

TEST(FrameTimes, InvalidSeriesAreRefused) {
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
  const std::vector<Frame> frames = Range("sunrise", "sunset", {}, 10);
  std::vector<int> numbers;
  for (const Frame& frame : SelectFrames(frames, "0,2-4,9,3")) numbers.push_back(frame.number);
  EXPECT_EQ(numbers, (std::vector<int>{0, 2, 3, 4, 9}));
  for (const char* bad : {"", "10", "3-2", "a", "1-", "-3", "1,,2", "1-2-3", "1 2", "9999999999"}) {
    EXPECT_NE(FaultOf([&] { return SelectFrames(frames, bad); }), "no fault") << bad;
  }
}

/// Returns the clock times of the frames in the zone, like "2026-03-27T12:00".
std::vector<std::string> ClocksOf(const TimesText& times, const EventDay& day) {
  std::vector<std::string> clocks;
  for (const Frame& frame : FramesFromTimes(times, day))
    clocks.push_back(FormatInZone(frame.instant, *day.zone).substr(0, 16));
  return clocks;
}
EventDay Zurich(const char* date) {
  EventDay day{Place{47.0, 8.0, 0.0}, "Europe/Zurich", {}};
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
      Range("02:30", "2026-10-26 12:00", "1d", {}, Zurich("2026-10-24"));
  ASSERT_EQ(twice.size(), 3U);
  EXPECT_EQ(FormatUtc(twice[1].instant), "2026-10-25T00:30:00Z") << "the first of the two";
  EXPECT_EQ(FormatUtc(twice[2].instant), "2026-10-26T01:30:00Z");
}

TEST(FrameTimes, ADayAloneIsTheDayOfTheLastFrame) {
  const std::vector<std::string> week{"2026-03-27T02:30", "2026-03-28T02:30", "2026-03-29T03:30",
                                      "2026-03-30T02:30", "2026-03-31T02:30"};
  for (const char* from : {"02:30", "0230", "2026-03-27 02:30", "2026-03-27T02:30:00"}) {
    EXPECT_EQ(ClocksOf({{}, from, "2026-03-31", "1d", {}}, Zurich("2026-03-27")), week) << from;
  }
  EXPECT_EQ(ClocksOf({{}, "2026-10-24 23:59", "2026-10-26", "1d", {}}, Zurich("2026-06-21")),
            (std::vector<std::string>{"2026-10-24T23:59", "2026-10-25T23:59", "2026-10-26T23:59"}));
  EXPECT_EQ(ClocksOf({{}, "00:00", "2026-03-29", "24h", {}}, Zurich("2026-03-27")),
            (std::vector<std::string>{"2026-03-27T00:00", "2026-03-28T00:00", "2026-03-29T00:00"}));
  EXPECT_EQ(ClocksOf({{}, "18:00", "2026-06-24", "2d", {}}, Zurich("2026-06-21")),
            (std::vector<std::string>{"2026-06-21T18:00", "2026-06-23T18:00"}));
  EXPECT_EQ(ClocksOf({{}, "18:00", "2026-06-21", "1d", {}}, Zurich("2026-06-21")).size(), 1U);
}

TEST(FrameTimes, RelativeDaysEndASeriesAsWrittenOnesDo) {
  EventDay day = Zurich("2026-06-21");
  day.now = ParseInstant("2026-06-21T20:00:00Z");
  EXPECT_EQ(ClocksOf({{}, "18:30", "tomorrow", "1d", {}}, day),
            (std::vector<std::string>{"2026-06-21T18:30", "2026-06-22T18:30"}));
  EXPECT_EQ(ClocksOf({{}, "now", "2026-06-23", "1d", {}}, day).back(), "2026-06-23T22:00");
  EXPECT_EQ(ClocksOf({{}, "tomorrow 18:30", "2026-06-23", "1d", {}}, day).size(), 2U);
  EXPECT_EQ(ClocksOf({{}, "today", "tomorrow", "1d", {}}, day).size(), 2U);
}

TEST(FrameTimes, DaysWithoutAZoneAreThoseThatAreWritten) {
  // At longitude 170 degrees the day of the meridian begins at 12:40 UTC.
  const auto last = [](const char* from) {
    EventDay day{Place{0.0, 170.0, 0.0}, {}, {}};
    day.around = DayFromText("2026-06-21", day);
    return FormatUtc(Range(from, "2026-06-23", "1d", {}, day).back().instant);
  };
  EXPECT_EQ(last("20:00Z"), "2026-06-23T20:00:00Z");
  EXPECT_EQ(last("2026-06-21T20:00:00Z"), "2026-06-23T20:00:00Z");
  EXPECT_EQ(last("05:00+09:00"), "2026-06-22T20:00:00Z");
}

TEST(FrameTimes, ADayAloneNeedsStepsOfDaysAndComesLast) {
  const EventDay day = Zurich("2026-06-21");
  for (const char* every : {"1h", "36h"})
    EXPECT_THAT(FaultOf([&] { return Range("12:00", "2026-06-23", every, {}, day); }),
                HasSubstr("at what time of that day"));
  EXPECT_THAT(FaultOf([&] { return Range("12:00", "2026-06-23", {}, 3, day); }),
              HasSubstr("at what time of that day"));
  EXPECT_THAT(FaultOf([&] { return Range("2026-06-20", "2026-06-23", "1d", {}, day); }),
              HasSubstr("at what time of that day"));
  EXPECT_THAT(FaultOf([&] { return Range("12:00", "2026-06-20", "1d", {}, day); }),
              HasSubstr("--to 2026-06-20 is before the day of --from"));
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
  const std::vector<Frame> frames = Range("sunrise-10m", "2027-06-20", "28d", {}, Fuji());
  ASSERT_EQ(frames.size(), 14U) << "both days belong to the series";
  for (const Frame& frame : frames) {
    EventDay day = Fuji();
    day.around = AddSeconds(*day.around, frame.number * 28.0 * 86400.0);
    EXPECT_EQ(frame.instant, InstantFromText("sunrise-10m", day)) << frame.number;
  }
}

TEST(FrameTimes, AWrittenFirstDayCountsAsTheDayOfTheEvent) {
  EventDay day = Fuji();
  day.around.reset();
  const std::vector<Frame> frames = Range("2026-06-21 sunset", "2026-06-27", "2d", {}, day);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(FormatUtc(frames[3].instant), FormatUtc(InstantFromText("2026-06-27 sunset", Fuji())));
}

TEST(FrameTimes, DaysWithoutTheEventHaveNoFrame) {
  const std::vector<Frame> year = Range("sunrise", "2026-12-31", "5d", {}, Tromso("2026-01-01"));
  // Midnight sun lasts from May 18th to July 26th (70 days), polar night from November 27th to
  // January 15th (50 days). The tolerance covers 6 days on which refraction decides.
  EXPECT_NEAR(static_cast<double>(year.size()), (365.0 - 70.0 - 50.0) / 5.0, 6.0 / 5.0);
  EXPECT_EQ(year.back().number, static_cast<int>(year.size()) - 1) << "numbered without gaps";
  EXPECT_NE(FaultOf([] { return Range("sunrise", "2026-06-25", "1d", {}, Tromso("2026-06-21")); }),
            "no fault")
      << "a series without a frame is none";
}

}  // namespace
}  // namespace alpenglow::renderer
