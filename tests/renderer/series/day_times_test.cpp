// SPDX-License-Identifier: MIT
#include "renderer/series/day_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/series/manifest.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using testing::Not;

EventDay Tromso() {
  EventDay day{PlaceFromDegrees(69.65, 18.96, 0.0), "Europe/Oslo", {}};
  day.around = DayFromText("2026-06-21", day);
  return day;
}

TEST(DayTimes, WhatDoesNotHappenIsLeftOut) {
  const std::vector<DayTimes> days = TimesOfDays(Tromso(), 2);
  ASSERT_EQ(days.size(), 2U);
  EXPECT_EQ(days[1].date, "2026-06-22");
  EXPECT_FALSE(days[0].at[3].has_value()) << "no sunrise under the midnight sun";
  EXPECT_TRUE(days[0].at[4].has_value());
  EXPECT_NEAR(days[0].noon_elevation_deg, 90.0 - 69.65 + 23.44, 0.05) << "and 1' of refraction";
  EXPECT_THAT(TableOf(days, Tromso().zone), HasSubstr("2026-06-21 --:-- --:-- --:-- --:-- 12:4"));
  EXPECT_THAT(CsvOf(days), HasSubstr("\n2026-06-21,,,,,2026-06-21T10:4"));
}

TEST(DayTimes, TheMoonGrowsToTheFullMoon) {
  EventDay day = Tromso();
  day.around = DayFromText("2026-06-15", day);              // new moon of 02:54 UTC
  const std::vector<DayTimes> days = TimesOfDays(day, 15);  // full moon on the 29th, 23:57 UTC
  for (std::size_t i = 1; i < days.size(); ++i) {
    EXPECT_GT(days[i].moon_illuminated, days[i - 1].moon_illuminated) << days[i].date;
  }
  EXPECT_LT(days.front().moon_illuminated, 0.01);
  EXPECT_GT(days.back().moon_illuminated, 0.99);
}

EventDay EclipsedDay(double latitude_deg, double longitude_deg) {
  EventDay day{PlaceFromDegrees(latitude_deg, longitude_deg, 0.0), "Europe/Madrid", {}};
  day.around = DayFromText("2026-08-11", day);
  return day;
}

TEST(DayTimes, AnEclipseStandsUnderItsDayWithContactsToTheSecond) {
  const EventDay day = EclipsedDay(42.3439, -3.6969);  // Burgos
  const std::vector<DayTimes> days = TimesOfDays(day, 3);
  EXPECT_FALSE(days[0].eclipse);
  ASSERT_TRUE(days[1].eclipse);
  EXPECT_FALSE(days[2].eclipse);
  EXPECT_TRUE(days[1].eclipse->at_deepest.disk.IsTotal());
  EXPECT_THAT(TableOf(days, day.zone), HasSubstr("\n           eclipse of the sun: begins 19:33:"));
  EXPECT_THAT(TableOf(days, day.zone), HasSubstr(", total 20:28:"));
  EXPECT_THAT(CsvOf(days), HasSubstr(",2026-08-12T17:33:"));
  EXPECT_THAT(CsvOf(days), HasSubstr(",1.0000\n2026-08-13,"));
}

// In Palma the sun sets between third and last contact; in Istanbul it has set before the first.
TEST(DayTimes, OfAnEclipseOnlyWhatIsSeenIsListed) {
  const std::vector<DayTimes> palma = TimesOfDays(EclipsedDay(39.5696, 2.6502), 2);
  ASSERT_TRUE(palma[1].eclipse);
  EXPECT_TRUE(palma[1].eclipse->whole.inner->third_contact.IsSeen());
  EXPECT_THAT(TableOf(palma, "Europe/Madrid"), Not(HasSubstr("ends")));
  EXPECT_THAT(CsvOf(palma), HasSubstr("Z,,1.")) << "no last contact before the magnitude";
  EXPECT_FALSE(TimesOfDays(EclipsedDay(41.0, 29.0), 2)[1].eclipse);
}

// Rome: the sun sets on the sea horizon while the moon still comes on.
TEST(DayTimes, AnEclipseIsDeepestAtSunsetWhereItsMaximumIsBelowTheHorizon) {
  const DayTimes rome = TimesOfDays(EclipsedDay(41.9, 12.5), 2)[1];
  ASSERT_TRUE(rome.eclipse);
  EXPECT_FALSE(rome.eclipse->whole.maximum.IsSeen());
  EXPECT_EQ(rome.eclipse->at_deepest.instant, rome.at[5]);
  EXPECT_LT(rome.eclipse->at_deepest.disk.Magnitude(),
            rome.eclipse->whole.maximum.disk.Magnitude());
}

TEST(FrameList, HasALineForEachFrameWithSunAndMoon) {
  const EventDay day = Tromso();
  std::vector<FrameRecord> records;
  for (const Frame& frame :
       FramesFromTimes({{"noon", "2026-06-21T22:00:00Z"}, {}, {}, {}, {}}, day)) {
    records.push_back(RecordOf(frame, day.place, day.zone));
    records.back().Set("file", FrameName("night.%03d.exr").Exr(frame.number).string());
  }
  const std::string text = ListOf(records);
  EXPECT_THAT(text, HasSubstr("\n0,2026-06-21T10:4"));
  EXPECT_THAT(text, HasSubstr("\n1,2026-06-21T22:00:00Z,2026-06-22T00:00:00+02:00,"));
  EXPECT_THAT(text, HasSubstr(",night.001.exr\n"));
}

}  // namespace
}  // namespace alpenglow::renderer
