// SPDX-License-Identifier: MIT
#include "atmosphere/time_place/time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/time_place/time_zone.h"
#include "tests/fixtures/comma_locale.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::atmosphere {
namespace {

std::string FaultOfInstant(std::string_view text,
                           const std::optional<std::string>& zone = std::nullopt) {
  return tests::FaultOf([&] { return ParseInstant(text, zone); });
}

// Hard case 25.
TEST(Time, TimesAreParsedInUtcAndWithOffsets) {
  const UtcTime expected{61212, 4 * 3600.0};
  EXPECT_EQ(ParseInstant("2026-06-21T04:00:00Z"), expected) << "MJD 61212 is 2026-06-21";
  EXPECT_EQ(ParseInstant("2026-06-21T13:00:00+09:00"), expected);
  EXPECT_EQ(ParseInstant("2026-06-20T18:30:00-09:30"), expected);
  EXPECT_EQ(ParseInstant("2026-06-21T04:00Z"), expected);
  EXPECT_EQ(ParseInstant("2026-06-21 04:00:00Z"), expected) << "a space stands for the T";
  EXPECT_EQ(ParseInstant("2026-06-21t04:00:00z"), expected) << "RFC 3339, 5.6";
  EXPECT_EQ(ParseInstant("2026-06-21T13:00:00", "Asia/Tokyo"), expected);
  EXPECT_EQ(ParseInstant("2026-06-21T04:00:00Z", "Asia/Tokyo"), expected) << "the text decides";
  EXPECT_EQ(ParseInstant("2000-01-01T12:00:00Z"), (UtcTime{51544, 43200.0})) << "J2000";
  EXPECT_EQ(ParseInstant("2024-02-29T00:00:00Z").modified_julian_day, 60369);
  EXPECT_NEAR(ParseInstant("2026-06-21T04:00:30.125Z").second_of_day, 14430.125, 1e-9);
  EXPECT_NEAR(ParseInstant("2026-06-21T04:00:30,125Z").second_of_day, 14430.125, 1e-9)
      << "ISO 8601 prefers the comma";
  EXPECT_LT(ParseInstant("2026-06-21T23:59:59.999999999Z").second_of_day, 86400.0);
  EXPECT_LT(ParseInstant("2026-06-21T23:59:59.99999999999999999999Z").second_of_day, 86400.0);
  EXPECT_NEAR(ParseInstant("2026-06-21T00:00:01.1234567890123Z").second_of_day, 1.123456789, 1e-9);
  EXPECT_EQ(ParseInstant("1900-01-01T00:00:00Z").modified_julian_day, 15020);
  EXPECT_EQ(ParseInstant("2100-12-31T23:59:59Z").modified_julian_day, 88433);
}

struct RefusedInstant {
  const char* text;
  const char* fault;
  std::optional<std::string> zone = std::nullopt;
};

void ExpectRefused(std::span<const RefusedInstant> instants) {
  for (const auto& [text, fault, zone] : instants)
    EXPECT_THAT(FaultOfInstant(text, zone), testing::HasSubstr(fault)) << text;
}

TEST(Time, InvalidTimesAreRefusedWithTextAndReason) {
  const RefusedInstant instants[] = {
      {"2024-02-30T00:00:00Z",
       "time \"2024-02-30T00:00:00Z\": the day in month 2 of 2024 is 30; it must lie in [1, 29]"},
      {"2023-02-29T00:00:00Z", "[1, 28]"},
      {"1900-02-29T00:00:00Z", "[1, 28]"},  // 1900 and 2100 are no leap years
      {"2100-02-29T00:00:00Z", "[1, 28]"},
      {"2024-06-21T24:00:00Z", "the hour is 24"},
      {"2024-06-21T23:60:00Z", "the minute is 60"},
      {"2024-06-21T23:59:61Z", "the second is 61"},
      {"2024-13-01T00:00:00Z", "the month is 13"},
      {"2024-06-21T04:00:00", "needs Z, an offset"},
      {"2024-06-21T04:00:00Zulu", "\"ulu\" is left over"},
      {"2024-06-21T04:00:00Z ", "left over"},
      {"10000-01-01T00:00:00Z", "[1900, 2100]"},
      {"1899-12-31T23:59:59Z", "[1900, 2100]"},
      {"2101-01-01T00:00:00Z", "[1900, 2100]"},
      {"1900-01-01T00:00:00+01:00", "is 1899"},
      {"2100-12-31T23:30:00-01:00", "is 2101"},
      {"2024-06-21T04:00:00", "Mars/Olympus", "Mars/Olympus"},
      {"2024-06-21T04:00:00+0900", "is written +09:00"},
      {"2024-06-21T04:00:00-03", "is written -03:00"},
  };
  ExpectRefused(instants);
  for (const char* text : {"",
                           "now",
                           "2024",
                           "2024-06-21",
                           "2024-06-21T",
                           "2024-06-21T04",
                           "2024-06-21T04Z",
                           "2024-6-21T04:00:00Z",
                           "24-06-21T04:00:00Z",
                           "2024-06-21  04:00:00Z",
                           "2024-06-21T4:00:00Z",
                           "2024-06-21T04:00:00.Z",
                           "2024-06-21T04:00:00+9:00",
                           "2024-06-21T04:00:00+16:00",
                           "2024-06-21T04:00:00+09:60",
                           "2024-06-21T04:00:00Z+09:00",
                           "-2024-06-21T04:00:00Z",
                           "+2024-06-21T04:00:00Z",
                           "2024-00-21T04:00:00Z",
                           "2024-06-00T04:00:00Z",
                           "2024-06-21T-4:00:00Z",
                           "2024-06-21T04:00:0xZ",
                           "nan"}) {
    EXPECT_NE(FaultOfInstant(text), "no fault") << text;
  }
}

// Hard case 25.
TEST(Time, TheLeapSecondOf2016Exists) {
  const UtcTime leap = ParseInstant("2016-12-31T23:59:60Z");
  EXPECT_EQ(leap, (UtcTime{57753, 86400.0}));
  EXPECT_EQ(ParseInstant("2017-01-01T08:59:60+09:00"), leap);
  EXPECT_EQ(ParseInstant("2017-01-01T08:59:60", "Asia/Tokyo"), leap);
  EXPECT_EQ(FormatUtc(leap), "2016-12-31T23:59:60Z");
  EXPECT_EQ(FormatUtc(ParseInstant("2016-12-31T23:59:60.75Z"), 2), "2016-12-31T23:59:60.75Z");
  EXPECT_EQ(FormatInZone(leap, "Asia/Tokyo"), "2017-01-01T08:59:60+09:00");
  EXPECT_EQ(AddSeconds(leap, 0.0), leap);
  EXPECT_EQ(AddSeconds(leap, 1.0), (UtcTime{57754, 1.0})) << "clocks do not count it";
  EXPECT_EQ(DayLength(57753), 86401.0);
  EXPECT_EQ(DayLength(57752), 86400.0);
}

// Hard case 25.
TEST(Time, Exactly27LeapSecondsUntil2026AreAccepted) {
  int leap_seconds = 0;
  for (int day = 15020; day < 61406; ++day) leap_seconds += DayLength(day) > 86400.0 ? 1 : 0;
  EXPECT_EQ(leap_seconds, 27) << "IERS bulletin C: 1972-06-30 to 2016-12-31";
  for (const char* text : {"2018-12-31T23:59:60Z", "2016-12-31T22:59:60Z",
                           "2016-12-31T23:59:60+09:00", "2050-06-30T23:59:60Z"})
    EXPECT_THAT(FaultOfInstant(text), testing::HasSubstr("there is no leap second"));
}

// Hard case 26.
TEST(Time, LocalTimesInAGapOrOverlapNeedTheOffset) {
  const RefusedInstant instants[] = {
      {"2026-03-29T02:30:00",
       "time \"2026-03-29T02:30:00\": clocks in Europe/Berlin skip this time (the offset goes from "
       "+01:00 to +02:00); write the offset that is meant",
       "Europe/Berlin"},
      {"2026-10-25T02:30:00",
       "time \"2026-10-25T02:30:00\": clocks in Europe/Berlin show this time twice; write the "
       "offset that is meant, +02:00 or +01:00",
       "Europe/Berlin"},
      {"2011-12-30T12:00:00", "skip this time", "Pacific/Apia"},  // Samoa left out a whole day
      {"2026-10-04T02:15:00", "+10:30 to +11:00", "Australia/Lord_Howe"},
      // The last Sunday of March 2050 is the 27th, in a year that zone tables do not reach.
      {"2050-03-27T02:30:00", "skip", "Europe/Berlin"},
      {"2050-10-30T02:30:00", "twice", "Europe/Berlin"},
  };
  ExpectRefused(instants);
}

TEST(Time, ZonesKnowOffsetsAfterTheirTablesEndIn2037) {
  const std::pair<const char*, const char*> in_berlin[] = {
      {"2026-10-25T02:30:00+02:00", "2026-10-25T00:30:00Z"},
      {"2026-03-29T01:59:59", "2026-03-29T00:59:59Z"},
      {"2026-03-29T03:00:00", "2026-03-29T01:00:00Z"},
      {"2026-10-25T03:00:00", "2026-10-25T02:00:00Z"},
      {"2050-07-01T12:00:00", "2050-07-01T10:00:00Z"},
      {"2050-01-01T12:00:00", "2050-01-01T11:00:00Z"}};
  for (const auto& [local, utc] : in_berlin)
    EXPECT_EQ(FormatUtc(ParseInstant(local, "Europe/Berlin")), utc) << local;
  const auto in = [](const char* zone, const char* utc) {
    return FormatInZone(ParseInstant(utc), zone);
  };
  EXPECT_EQ(in("Australia/Sydney", "2100-12-21T12:00:00Z"), "2100-12-21T23:00:00+11:00");
  EXPECT_EQ(in("Australia/Sydney", "2100-06-21T12:00:00Z"), "2100-06-21T22:00:00+10:00");
  EXPECT_EQ(in("Asia/Kathmandu", "2060-06-21T12:00:00Z"), "2060-06-21T17:45:00+05:45");
}

std::int64_t RuleOffset(std::string_view rule, int year, unsigned month, unsigned day, int hour) {
  using std::chrono::sys_days;
  const auto instant =
      sys_days(std::chrono::year(year) / std::chrono::month(month) / std::chrono::day(day)) +
      std::chrono::hours(hour);
  return OffsetAt(ParsePosixZoneRule(rule).value(), instant).count();
}

TEST(Time, RulesOfZoneFilesAreUnderstood) {
  EXPECT_EQ(RuleOffset("JST-9", 2050, 6, 1, 0), 32400);
  EXPECT_EQ(RuleOffset("<+1245>-12:45<+1345>,M9.5.0/2:45,M4.1.0/3:45", 2050, 1, 1, 0), 49500);
  EXPECT_EQ(RuleOffset("<+1245>-12:45<+1345>,M9.5.0/2:45,M4.1.0/3:45", 2050, 7, 1, 0), 45900);
  EXPECT_EQ(RuleOffset("IST-1GMT0,M10.5.0,M3.5.0/1", 2050, 7, 1, 0), 3600) << "Irish winter time";
  EXPECT_EQ(RuleOffset("IST-1GMT0,M10.5.0,M3.5.0/1", 2050, 1, 1, 0), 0);
  // Nuuk changes at 1:00 UTC on the last Sunday of March: Saturday 23:00 there.
  EXPECT_EQ(RuleOffset("<-02>2<-01>,M3.5.0/-1,M10.5.0/0", 2050, 3, 27, 0), -7200);
  EXPECT_EQ(RuleOffset("<-02>2<-01>,M3.5.0/-1,M10.5.0/0", 2050, 3, 27, 1), -3600);
  for (const char* text :
       {"", "CE", "CET", "CET-1CEST", "CET-1CEST,M3.5.0", "CET-1CEST,M13.5.0,M10.5.0",
        "CET-1CEST,M3.6.0,M10.5.0", "CET-1CEST,M3.5.7,M10.5.0", "CET-1CEST,M3.5.0,M10.5.0/3x",
        "<+01-1", "CET-1CEST,J60,J300"}) {
    EXPECT_FALSE(ParsePosixZoneRule(text).has_value()) << text;
  }
}

TEST(Time, LocalMeanTimeSurvivesARoundTrip) {
  const UtcTime instant = ParseInstant("1950-06-01T12:00:00Z");
  const std::string text = FormatInZone(instant, "Africa/Monrovia");
  EXPECT_EQ(text, "1950-06-01T11:15:30-00:44:30") << "Liberia until 1972";
  EXPECT_EQ(ParseInstant(text), instant);
}

TEST(Time, FormattingRoundsAndCarries) {
  EXPECT_EQ(FormatUtc({61212, 14400.0}), "2026-06-21T04:00:00Z");
  EXPECT_EQ(FormatUtc({61212, 14400.1236}, 3), "2026-06-21T04:00:00.124Z");
  EXPECT_EQ(FormatUtc({61212, 86399.9996}, 3), "2026-06-22T00:00:00.000Z");
  EXPECT_EQ(FormatUtc({57753, 86399.9996}, 3), "2016-12-31T23:59:60.000Z") << "the leap second";
  EXPECT_EQ(FormatUtc({57753, 86400.9996}, 3), "2017-01-01T00:00:00.000Z");
  EXPECT_EQ(FormatInZone({61212, 14400.0}, "Asia/Tokyo"), "2026-06-21T13:00:00+09:00");
  EXPECT_EQ(FormatInZone({61212, 14400.0}, "UTC"), "2026-06-21T04:00:00+00:00");
  EXPECT_EQ(FormatInZone({61212, 14400.0}, "America/St_Johns"), "2026-06-21T01:30:00-02:30");
  EXPECT_THROW((void)FormatInZone({}, "../../etc/passwd"), InputError);
}

TEST(Time, FormattedTimesAreParsedBack) {
  for (int day = 15020; day <= 88433; day += 911) {
    for (const double second : {0.0, 1.0, 43199.0, 86399.0}) {
      const UtcTime instant{day, second};
      EXPECT_EQ(ParseInstant(FormatUtc(instant)), instant);
      if (day > 15020) {
        EXPECT_EQ(ParseInstant(FormatInZone(instant, "Europe/Zurich")), instant);
      }
    }
  }
}

TEST(Time, AddingSecondsIsUndoneByAddingTheirNegative) {
  const UtcTime instant{61212, 14400.0};
  EXPECT_EQ(AddSeconds(instant, 86400.0 * 365), (UtcTime{61577, 14400.0}));
  EXPECT_EQ(AddSeconds(instant, -14400.5), (UtcTime{61211, 86399.5}));
  EXPECT_EQ(AddSeconds({61212, 0.0}, -1e-20), (UtcTime{61212, 0.0})) << "never 86400.0";
  for (const double step : {-1e7, -86400.0, -0.25, 0.5, 3600.0, 12345678.5}) {
    const UtcTime moved = AddSeconds(instant, step);
    EXPECT_EQ(SecondsBetween(instant, moved), step);
    EXPECT_EQ(AddSeconds(moved, -step), instant);
    EXPECT_GE(moved.second_of_day, 0.0);
    EXPECT_LT(moved.second_of_day, 86400.0);
  }
  EXPECT_THROW((void)AddSeconds(instant, std::nan("")), InputError);
}

TEST(Time, DurationsAreNumbersWithUnits) {
  EXPECT_EQ(ParseDuration("1h30m"), 5400.0);
  EXPECT_EQ(ParseDuration("90s"), 90.0);
  EXPECT_EQ(ParseDuration("-20m"), -1200.0);
  EXPECT_EQ(ParseDuration("+20m"), 1200.0);
  EXPECT_EQ(ParseDuration("2d"), 172800.0);
  EXPECT_EQ(ParseDuration("1d2h3m4.5s"), 93784.5);
  EXPECT_EQ(ParseDuration("0.5h"), 1800.0);
  for (const char* text : {"", "-", "90", "h", "1x", "30m1h", "1h1h", "1h 30m", "1e3s", "infs",
                           "nans", "--1s", "1.2.3s", "1h-30m", "0x10s", ".", ".s", "1,5h"}) {
    EXPECT_THROW((void)ParseDuration(text), InputError) << text;
  }
}

using TimeInOtherLocale = TemporaryFolder;

TEST_F(TimeInOtherLocale, IsNotAffectedByADecimalComma) {
  const tests::CommaLocale locale(folder_);
  EXPECT_NEAR(ParseInstant("2026-06-21T04:00:30.125Z").second_of_day, 14430.125, 1e-9);
  EXPECT_EQ(ParseDuration("1.5s"), 1.5);
  EXPECT_EQ(FormatUtc({61212, 14400.125}, 3), "2026-06-21T04:00:00.125Z");
  EXPECT_EQ(FormatInZone({61212, 14400.0}, "Europe/Zurich"), "2026-06-21T06:00:00+02:00");
}

TEST(Time, DeltaTAgreesWithObservations) {
  const auto at = [](const char* text) { return DeltaT(ParseInstant(text)); };
  // Espenak and Meeus (2006), table of observed values, rounded there to 0.01 s before 1955.
  EXPECT_NEAR(at("1900-01-01T00:00:00Z"), -2.7, 0.5);
  EXPECT_NEAR(at("1930-01-01T00:00:00Z"), 24.0, 0.5);
  EXPECT_NEAR(at("1950-01-01T00:00:00Z"), 29.07, 0.2);
  EXPECT_NEAR(at("1970-01-01T00:00:00Z"), 40.18, 0.9) << "UT1 - UTC is neglected";
  EXPECT_NEAR(at("2000-01-01T00:00:00Z"), 63.83, 0.9);
  EXPECT_DOUBLE_EQ(at("2020-01-01T00:00:00Z"), 69.184) << "37 leap seconds and 32.184 s";
  EXPECT_DOUBLE_EQ(at("2016-12-31T23:59:60Z"), 68.184);
  EXPECT_DOUBLE_EQ(at("2017-01-01T00:00:00Z"), 69.184);
  EXPECT_NEAR(at("2100-01-01T00:00:00Z"), 202.7 - 6.5, 1.0)
      << "the forecast less its error of 2027";
}

TEST(Time, DeltaTIsContinuousBetweenModels) {
  for (const char* text :
       {"1920-01-01T12:00:00Z", "1941-01-01T00:00:00Z", "1950-01-01T00:00:00Z",
        "1960-01-01T00:00:00Z", "2027-01-01T00:00:00Z", "2050-01-01T00:00:00Z"}) {
    for (int day = -3; day < 3; ++day) {
      const UtcTime before = AddSeconds(ParseInstant(text), 86400.0 * day);
      EXPECT_NEAR(DeltaT(AddSeconds(before, 86400.0)), DeltaT(before), 0.02)
          << text << ": a day changes it by 0.008 s at most; the polynomials of 1920 and 1941 miss "
          << "each other by 0.012 s";
    }
  }
  for (const char* seam : {"1960-01-01T00:00:00Z", "2027-01-01T00:00:00Z"})
    EXPECT_NEAR(DeltaT(AddSeconds(ParseInstant(seam), -1e-3)), DeltaT(ParseInstant(seam)), 1e-6);
}

}  // namespace
}  // namespace alpenglow::atmosphere
