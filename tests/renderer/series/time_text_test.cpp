// SPDX-License-Identifier: MIT
#include "renderer/series/time_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
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

TEST(TimeText, AnInstantIsReadAsItStands) {
  EXPECT_EQ(FormatUtc(InstantFromText("2026-06-21T04:00:00Z", Fuji())), "2026-06-21T04:00:00Z");
  EXPECT_EQ(FormatUtc(InstantFromText("2026-06-21T13:00:00", Fuji())), "2026-06-21T04:00:00Z")
      << "without Z or offset in the zone of the place";
}

TEST(TimeText, AnEventIsFoundOnTheLocalDay) {
  const EventDay day = Fuji();
  const UtcInstant sunrise = InstantFromText("sunrise", day);
  EXPECT_EQ(FormatInZone(sunrise, "Asia/Tokyo").substr(0, 14), "2026-06-21T04:")
      << "the sun rises over Fuji in midsummer between 4 and 5 o'clock";
  const UtcInstant sunset = InstantFromText("sunset", day);
  EXPECT_EQ(FormatInZone(sunset, "Asia/Tokyo").substr(0, 14), "2026-06-21T19:");
}

TEST(TimeText, OffsetsMoveTheEvent) {
  const EventDay day = Fuji();
  const UtcInstant dusk = InstantFromText("civil-dusk", day);
  EXPECT_NEAR(SecondsBetween(dusk, InstantFromText("civil-dusk+20m", day)), 1200.0, 1e-6);
  EXPECT_NEAR(SecondsBetween(dusk, InstantFromText("civil-dusk-1h30m", day)), -5400.0, 1e-6);
  EXPECT_NEAR(SecondsBetween(InstantFromText("noon", day), InstantFromText("noon-90s", day)), -90.0,
              1e-6);
}

TEST(TimeText, UnknownEventsNameTheNearest) {
  EXPECT_THAT(FaultOf([] { return InstantFromText("sunris-1h", Fuji()); }),
              HasSubstr("unknown event \"sunris\"; did you mean sunrise?"));
  EXPECT_THAT(FaultOf([] { return InstantFromText("teatime", Fuji()); }),
              HasSubstr("unknown event"));
  for (const char* text : {"", "sunrise+", "sunrise-1x", "2024-02-30T00:00:00Z", "sunrise 1h"}) {
    EXPECT_NE(FaultOf([&] { return InstantFromText(text, Fuji()); }), "no fault") << text;
  }
}

TEST(TimeText, OtherWaysToWriteATimeNameTheOneThatIsRead) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"6pm", "did you mean 18:00?"},
      {"12 AM", "did you mean 00:00?"},
      {"6:30 p.m.", "did you mean 18:30?"},
      {"9:30", "did you mean 09:30?"},
      {"18h30", "did you mean 18:30?"},
      {"2026-06-21 6pm", "did you mean 18:00?"},
      {"tomorrow 6pm", "did you mean 18:00?"},
      {"2026-06-21T18:00:00+0200", "the offset \"+0200\" is written +02:00"},
      {"18:00-03", "the offset \"-03\" is written -03:00"},
      {"+0200", "an offset follows a time"}};
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(FaultOf([&] { return InstantFromText(text, Fuji()); }), HasSubstr(message)) << text;
  }
  EXPECT_EQ(FaultOf([] { return InstantFromText("18:30:15", Fuji()); }), "no fault");
}

TEST(TimeText, ContactsOfAnEclipseAreTimes) {
  EventDay day{PlaceFromDegrees(42.3439, -3.6969, 860.0), "Europe/Madrid", {}};  // Burgos
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
  const EventDay madrid{PlaceFromDegrees(40.4168, -3.7038, 660.0), "Europe/Madrid", day.around};
  EXPECT_THAT(FaultOf([&] { return InstantFromText("second-contact", madrid); }),
              HasSubstr("no such eclipse of the sun"))
      << "partial";
  EXPECT_THAT(FaultOf([] { return InstantFromText("first-contact", Fuji()); }),
              HasSubstr("no such eclipse of the sun"));
}

TEST(TimeText, AnEventNeedsADay) {
  EventDay day = Fuji();
  day.around.reset();
  EXPECT_THAT(FaultOf([&] { return InstantFromText("sunrise", day); }), HasSubstr("which day"));
}

// Hard case 24.
TEST(TimeText, PolarDayAndNightHaveNoSunrise) {
  EXPECT_THAT(FaultOf([] { return InstantFromText("sunrise", Tromso("2026-06-21")); }),
              HasSubstr("polar day"));
  EXPECT_THAT(FaultOf([] { return InstantFromText("sunset+5m", Tromso("2026-12-21")); }),
              HasSubstr("polar night"));
  const auto both = [](const char* event, const char* date) {
    return FaultOf([&] { return InstantFromText(event, Tromso(date)); });
  };
  EXPECT_THAT(both("sunset", "2026-06-21"), HasSubstr("there is no sunset on 2026-06-21"));
  EXPECT_THAT(both("sunset", "2026-06-21"), Not(HasSubstr("night")));
  EXPECT_THAT(both("sunrise", "2026-12-21"), Not(HasSubstr("polar day")));
  EXPECT_THAT(both("astronomical-dusk", "2026-05-10"), HasSubstr("the night is light"));
  EXPECT_EQ(FaultOf([] { return InstantFromText("noon", Tromso("2026-12-21")); }), "no fault");
}

TEST(TimeText, TheDayOfAPlaceWithoutZoneIsThatOfItsMeridian) {
  const EventDay fiji{PlaceFromDegrees(-17.7, 178.0, 0.0), {}, {}};
  EXPECT_EQ(FormatUtc(DayFromText("2026-06-21", fiji)), "2026-06-21T00:08:00Z");
  EXPECT_THROW((void)DayFromText("2026-6-21", fiji), InputError);
  EXPECT_THROW((void)DayFromText("2026-02-30", fiji), InputError);
}

/// A machine's clock that stands at 23:30 of June 21st in Tokyo.
EventDay LateOnTheDay() {
  EventDay day = Fuji();
  day.around.reset();
  day.now = ParseInstant("2026-06-21T23:30:00+09:00");
  return day;
}

TEST(TimeText, NowIsWhatTheClockShows) {
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
  EXPECT_THAT(FaultOf([&] { return InstantFromText("2026-06-22", day); }), HasSubstr("what time"))
      << "a date may be meant to begin or to end a series";
}

TEST(TimeText, FourDigitsAreAClockTime) {
  const EventDay day = Fuji();
  EXPECT_EQ(InstantFromText("1830", day), InstantFromText("18:30", day));
  EXPECT_EQ(InstantFromText("0005Z", day), InstantFromText("00:05Z", day));
  EXPECT_EQ(InstantFromText("tomorrow 0600", LateOnTheDay()),
            InstantFromText("tomorrow 06:00", LateOnTheDay()));
  EXPECT_EQ(InstantFromText("2026-06-22 1830", day), InstantFromText("2026-06-22 18:30", day));
  EXPECT_TRUE(IsClockTime("1830"));
  for (const char* bad : {"2460", "183", "18300"})
    EXPECT_NE(FaultOf([&] { return InstantFromText(bad, day); }), "no fault") << bad;
}

TEST(TimeText, MidnightIsWhereTheSunIsLowest) {
  for (const double latitude : {0.0, 46.5, 69.0}) {
    EventDay day = Fuji();
    day.place.latitude_rad = latitude * kRadiansPerDegree;
    const UtcInstant midnight = InstantFromText("midnight", day);
    const double lowest = SunAt(day.place, midnight).elevation_rad;
    for (const double seconds : {-600.0, 600.0})
      EXPECT_LT(lowest, SunAt(day.place, AddSeconds(midnight, seconds)).elevation_rad) << latitude;
    EXPECT_GT(SecondsBetween(InstantFromText("noon", day), midnight), 0.0) << "it ends the day";
    EXPECT_EQ(InstantFromText("midnight+20m", day), AddSeconds(midnight, 1200.0));
  }
}

TEST(TimeText, TomorrowIsTheNextDayWhereClocksAreSet) {
  EventDay zurich{PlaceFromDegrees(47.4, 8.5, 400.0), "Europe/Zurich", {}};
  for (const char* now : {"2026-03-28T23:59:00+01:00", "2026-03-28T00:01:00+01:00"}) {
    zurich.now = ParseInstant(now);
    EXPECT_EQ(DateAt(DayFromText("tomorrow", zurich), zurich), "2026-03-29") << now;
  }
}

TEST(TimeText, AClockTimeIsOfTheDay) {
  EXPECT_EQ(FormatUtc(InstantFromText("18:30", Fuji())), "2026-06-21T09:30:00Z");
  EXPECT_EQ(FormatUtc(InstantFromText("18:30:15", Fuji())), "2026-06-21T09:30:15Z");
  EXPECT_EQ(FormatUtc(InstantFromText("18:30Z", Fuji())), "2026-06-21T18:30:00Z");
  EXPECT_EQ(FormatUtc(InstantFromText("2026-06-22 18:30", Fuji())), "2026-06-22T09:30:00Z");
  EventDay day = Fuji();
  day.zone.reset();
  EXPECT_THAT(FaultOf([&] { return InstantFromText("18:30", day); }), HasSubstr("time zone"));
  day.around.reset();
  EXPECT_THAT(FaultOf([&] { return InstantFromText("18:30Z", day); }), HasSubstr("which day"));
}

TEST(TimeText, TheMoonHasEventsOfTheDay) {
  const EventDay day = Fuji();
  const UtcInstant rise = InstantFromText("moonrise", day);
  const UtcInstant next = *NextMoonrise(day.place, ParseInstant("2026-06-21T00:00:00+09:00"));
  EXPECT_NEAR(SecondsBetween(next, rise), 0.0, 0.1) << "the error of its search";
  EXPECT_NEAR(SecondsBetween(rise, InstantFromText("moonrise+20m", day)), 1200.0, 1e-6);
  const UtcInstant transit = InstantFromText("moon-transit", day);
  const double before = MoonAt(day.place, AddSeconds(transit, -900.0)).elevation_rad;
  const double at = MoonAt(day.place, transit).elevation_rad;
  const double after = MoonAt(day.place, AddSeconds(transit, 900.0)).elevation_rad;
  EXPECT_GT(at, before);
  EXPECT_GT(at, after);
}

TEST(TimeText, ADayWithoutMoonriseSaysWhenTheNextIs) {
  EventDay day = Fuji();
  int without = 0;
  for (int i = 0; i < 30; ++i) {
    day.around = AddSeconds(*Fuji().around, i * 86400.0);
    if (FindDailyEvent("moonrise", day)) continue;
    ++without;
    EXPECT_THAT(FaultOf([&] { return InstantFromText("moonrise", day); }),
                HasSubstr("the next is at"));
  }
  EXPECT_EQ(without, 1) << "a moon of 29.5 days rises 28.5 times";
}

/// What happens on a date of mean solar time at sea level, from the month on.
struct AlmanacDay {
  const char* name;
  double latitude_deg, longitude_deg;
  const char* date;
  std::array<const char*, 6> utc;  // in the order of kAlmanacEvents
};
constexpr std::array<const char*, 6> kAlmanacEvents{"sunrise",  "noon",         "sunset",
                                                    "moonrise", "moon-transit", "moonset"};

// libastro of XEphem (VSOP 87, ELP 2000-82 truncated by Moshier), upper limb at 34' under the
// horizon, through PyEphem 4.1.4. Almanacs round to the minute; sunrise is wanted within 10 s and
// moonrise within 60 s.
TEST(TimeText, SunAndMoonKeepToAnAlmanac) {
  const std::vector<AlmanacDay> days{
      {"Greenwich",
       51.4779,
       0.0,
       "2026-03-20",
       {"03-20T06:02:53", "03-20T12:07:26", "03-20T18:12:59", "03-20T06:16:07", "03-20T13:14:47",
        "03-20T20:34:45"}},
      {"Greenwich",
       51.4779,
       0.0,
       "2026-08-12",
       {"08-12T04:40:45", "08-12T12:05:03", "08-12T19:28:16", "08-12T03:56:05", "08-12T11:53:53",
        "08-12T19:28:53"}},
      {"Tokyo",
       35.6895,
       139.6917,
       "2026-03-20",
       {"03-19T20:45:36", "03-20T02:48:46", "03-20T08:52:31", "03-19T21:06:09", "03-20T03:36:49",
        "03-20T10:18:37"}},
      {"Tokyo",
       35.6895,
       139.6917,
       "2026-08-12",
       {"08-11T19:57:28", "08-12T02:46:21", "08-12T09:34:41", "08-11T18:54:51", "08-12T02:13:45",
        "08-12T09:21:25"}},
      {"Quito",
       -0.2167,
       -78.5,
       "2026-03-20",
       {"03-20T11:18:07", "03-20T17:21:22", "03-20T23:24:37", "03-20T12:28:00", "03-20T18:39:46",
        "03-21T00:51:40"}},
      {"Quito",
       -0.2167,
       -78.5,
       "2026-08-12",
       {"08-12T11:15:52", "08-12T17:19:01", "08-12T23:22:10", "08-12T11:07:07", "08-12T17:19:35",
        "08-12T23:31:49"}},
      {"Ushuaia",
       -54.8,
       -68.3,
       "2026-03-20",
       {"03-20T10:34:29", "03-20T16:40:34", "03-20T22:45:31", "03-20T12:50:36", "03-20T17:57:32",
        "03-20T22:47:48"}},
      {"Ushuaia",
       -54.8,
       -68.3,
       "2026-08-12",
       {"08-12T12:00:20", "08-12T16:38:13", "08-12T21:16:51", "08-12T12:11:20", "08-12T16:37:16",
        "08-12T21:18:22"}},
      {"Tromso",
       69.65,
       18.96,
       "2026-03-20",
       {"03-20T04:43:53", "03-20T10:51:36", "03-20T17:01:30", "03-20T04:08:58", "03-20T11:56:19",
        "03-20T20:42:52"}},
      {"Tromso",
       69.65,
       18.96,
       "2026-08-12",
       {"08-12T01:29:25", "08-12T10:49:13", "08-12T20:04:52", "08-11T23:10:18", "08-12T10:35:11",
        "08-12T19:59:01"}},
  };
  for (const AlmanacDay& row : days) {
    EventDay day{PlaceFromDegrees(row.latitude_deg, row.longitude_deg, 0.0), {}, {}};
    day.around = DayFromText(row.date, day);
    for (std::size_t i = 0; i < row.utc.size(); ++i) {
      const auto instant = FindDailyEvent(kAlmanacEvents[i], day);
      ASSERT_TRUE(instant.has_value()) << row.name << ' ' << row.date << ' ' << kAlmanacEvents[i];
      const UtcInstant expected = ParseInstant(fmt::format("2026-{}Z", row.utc[i]));
      EXPECT_NEAR(SecondsBetween(expected, *instant), 0.0, i < 3 ? 10.0 : 60.0)
          << row.name << ' ' << row.date << ' ' << kAlmanacEvents[i];
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
