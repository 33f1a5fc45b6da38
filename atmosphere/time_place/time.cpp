// SPDX-License-Identifier: MIT
// Instants, leap seconds, and the rotation of the earth relative to atomic time.
//
// Espenak, F. and Meeus, J. (2006), Five Millennium Canon of Solar Eclipses, NASA/TP-2006-214141,
// section 2.3: polynomials of TT - UT1 in the year. Leap seconds are ERFA's table
// (IERS bulletin C).
#include "atmosphere/time_place/time.h"

#include <erfa.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time_zone.h"

namespace alpenglow::atmosphere {
namespace {

using std::chrono::days;
using std::chrono::seconds;
using std::chrono::sys_days;
using std::chrono::sys_seconds;

constexpr int kUnixEpoch = 40587;  // modified Julian day of 1970-01-01
constexpr int kDay_s = static_cast<int>(kSecondsPerDay);

sys_days DayOf(int modified_julian_day) { return sys_days(days(modified_julian_day - kUnixEpoch)); }

/// A time as written, with calendar and clock, before its offset from UTC is resolved.
struct WrittenTime {
  sys_seconds second;  // calendar and clock, counted as if they were UTC; ":60" as ":59"
  bool is_leap_second = false;
  double fraction = 0.0;          // of a second, [0, 1)
  std::optional<seconds> offset;  // local minus UTC, 0 for Z
};

/// Reads the parts of ISO 8601 and reports the first that is wrong.
class InstantReader {
 public:
  explicit InstantReader(std::string_view text) : text_(text), cursor_(text) {}

  WrittenTime Read() {
    const sys_days day = Date();
    if (!cursor_.Accept('T') && !cursor_.Accept('t') && !cursor_.Accept(' ')) {
      Refuse("expected T or a space, and a time, after the date");
    }
    WrittenTime written = TimeOfDay(day);
    written.offset = Offset();
    if (!cursor_.AtEnd()) Refuse(fmt::format("\"{}\" is left over at the end", cursor_.rest()));
    return written;
  }

  [[noreturn]] void Refuse(const std::string& fault) const {
    throw InputError(fmt::format("time \"{}\": {}", text_, fault));
  }

 private:
  int Part(const char* name, int low, int high) {
    const std::optional<int> value = cursor_.Number(2, 2);
    if (!value) Refuse(fmt::format("the {} must be two digits", name));
    if (*value < low || *value > high) {
      Refuse(fmt::format("the {} is {}; it must lie in [{}, {}]", name, *value, low, high));
    }
    return *value;
  }

  sys_days Date() {
    const std::optional<int> year = cursor_.Number(4, 4);
    if (!year || *year < kFirstYear || *year > kLastYear) {
      Refuse(
          fmt::format("the year must be four digits and lie in [{}, {}]", kFirstYear, kLastYear));
    }
    if (!cursor_.Accept('-')) Refuse("expected - after the year");
    const int month = Part("month", 1, 12);
    if (!cursor_.Accept('-')) Refuse("expected - after the month");
    const std::chrono::year_month year_month =
        std::chrono::year(*year) / std::chrono::month(static_cast<unsigned>(month));
    const auto last = static_cast<unsigned>((year_month / std::chrono::last).day());
    const int day =
        Part(fmt::format("day in month {} of {}", month, *year).c_str(), 1, static_cast<int>(last));
    return year_month / day;
  }

  WrittenTime TimeOfDay(sys_days day) {
    const int hour = Part("hour", 0, 23);
    if (!cursor_.Accept(':')) Refuse("expected : after the hour");
    const int minute = Part("minute", 0, 59);
    const int second = cursor_.Accept(':') ? Part("second", 0, 60) : 0;
    WrittenTime written;
    written.is_leap_second = second == 60;
    written.second = sys_seconds(day) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
                     seconds(std::min(second, 59));
    if (cursor_.Accept('.') || cursor_.Accept(',')) {
      // More digits than nanoseconds, as some recorders write, could round up to the next second.
      constexpr std::size_t kDigits = 9;
      const std::string_view digits = cursor_.Run("0123456789").substr(0, kDigits);
      if (digits.empty()) Refuse("a fraction of a second has digits");
      for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
        written.fraction = (written.fraction + (*digit - '0')) / 10.0;
      }
    }
    return written;
  }

  /// Offsets without a colon, "+0200" and "+02", belong to another form of ISO 8601, which is
  /// rejected.
  void RequireColonIn(std::string_view offset) const {
    const std::string_view digits = offset.substr(1);
    const bool is_number = digits.find_first_not_of("0123456789") == std::string_view::npos;
    if (!is_number || (digits.size() != 2 && digits.size() != 4)) return;
    const std::string_view minutes = digits.size() == 4 ? digits.substr(2) : "00";
    Refuse(fmt::format("the offset \"{}\" is written {}:{}", offset, offset.substr(0, 3), minutes));
  }

  std::optional<seconds> Offset() {
    if (cursor_.Accept('Z') || cursor_.Accept('z')) return seconds(0);
    const std::string_view whole = cursor_.rest();
    const bool west = cursor_.Accept('-');
    if (!west && !cursor_.Accept('+')) return std::nullopt;
    RequireColonIn(whole);
    int total_s = 3600 * Part("hour of the offset", 0, 15);
    if (!cursor_.Accept(':')) Refuse("expected : after the hour of the offset");
    total_s += 60 * Part("minute of the offset", 0, 59);
    // This extends ISO 8601: local mean times, in force until 1972 in some places, have seconds.
    if (cursor_.Accept(':')) total_s += Part("second of the offset", 0, 59);
    return seconds(west ? -total_s : total_s);
  }

  std::string_view text_;
  TextCursor cursor_;
};

/// Returns "+09:00"; with seconds if they are not zero.
std::string OffsetText(seconds offset) {
  const std::int64_t size_s = std::abs(offset.count());
  std::string text =
      fmt::format("{}{:02}:{:02}", offset.count() < 0 ? '-' : '+', size_s / 3600, size_s / 60 % 60);
  if (size_s % 60 != 0) text += fmt::format(":{:02}", size_s % 60);
  return text;
}

seconds OffsetInZone(const InstantReader& reader, sys_seconds local, const std::string& name) {
  const TimeZone zone(name);
  const std::vector<seconds> offsets = zone.OffsetsOf(local);
  if (offsets.size() == 1) return offsets.front();
  if (offsets.empty()) {
    reader.Refuse(
        fmt::format("clocks in {} skip this time (the offset goes from {} to {}); write the offset "
                    "that is meant",
                    name, OffsetText(zone.OffsetAt(local - days(1))),
                    OffsetText(zone.OffsetAt(local + days(1)))));
  }
  reader.Refuse(
      fmt::format("clocks in {} show this time twice; write the offset that is meant, {} or {}",
                  name, OffsetText(offsets.back()), OffsetText(offsets.front())));
}

/// An instant on a grid of 10^-decimals seconds.
struct RoundedInstant {
  int modified_julian_day;
  int second_of_day;      // up to 86400 on a day with a leap second
  std::int64_t fraction;  // in units of 10^-decimals s
};

RoundedInstant Rounded(const UtcTime& instant, int decimals) {
  ALPENGLOW_ENSURE(decimals, >=, 0);
  ALPENGLOW_ENSURE(decimals, <=, 9);
  std::int64_t scale = 1;
  for (int i = 0; i < decimals; ++i) scale *= 10;
  const std::int64_t units = std::llround(instant.second_of_day * static_cast<double>(scale));
  const auto second = static_cast<int>(units / scale);
  if (second >= DayLength(instant.modified_julian_day)) {  // rounded up, past midnight
    return {instant.modified_julian_day + 1, 0, 0};
  }
  return {instant.modified_julian_day, second, units % scale};
}

std::string Formatted(const UtcTime& instant, int decimals, const TimeZone* zone) {
  const RoundedInstant rounded = Rounded(instant, decimals);
  const int leap_s = std::max(rounded.second_of_day - (kDay_s - 1), 0);
  const sys_seconds utc =
      DayOf(rounded.modified_julian_day) + seconds(rounded.second_of_day - leap_s);
  const seconds offset = zone == nullptr ? seconds(0) : zone->OffsetAt(utc);
  const sys_seconds local = utc + offset;
  const sys_days day = std::chrono::floor<days>(local);
  const std::chrono::year_month_day date(day);
  const std::int64_t second = (local - day).count();
  std::string text =
      fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                  static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                  second / 3600, second / 60 % 60, second % 60 + leap_s);
  if (decimals > 0) text += fmt::format(".{:0{}}", rounded.fraction, decimals);
  return text + (zone == nullptr ? "Z" : OffsetText(offset));
}

constexpr int kFirstDayOfUtc = 36934;          // 1960-01-01
constexpr int kFirstDayOfLeapSeconds = 41317;  // 1972-01-01
constexpr int kFirstDayUnknown = 61406;        // 2027-01-01: ERFA reports later dates as dubious
constexpr double kTtMinusTai_s = 32.184;       // IAU 1991 resolution A4

/// Returns TT - UTC in [1960, 2027). UTC had its own rates until 1972, and has had steps of a
/// second since.
double TtMinusUtc(int modified_julian_day, double second_of_day) {
  int year = 0;
  int month = 0;
  int day = 0;
  double fraction = 0.0;
  eraJd2cal(2400000.5, modified_julian_day, &year, &month, &day, &fraction);
  double tai_minus_utc_s = 0.0;
  const int status =
      eraDat(year, month, day, std::min(second_of_day / kSecondsPerDay, 1.0), &tai_minus_utc_s);
  ALPENGLOW_ENSURE(status, >=, 0);  // positive: dubious, but the best available result
  return tai_minus_utc_s + kTtMinusTai_s;
}

/// Returns the polynomial for 1900 to 1961 and 2005 to 2150, held constant outside; the years
/// between are not needed.
double EspenakMeeus(double year) {
  const double y = std::clamp(year, 1900.0, 2150.0);
  if (y < 1920.0) {
    const double t = y - 1900.0;
    return -2.79 + t * (1.494119 + t * (-0.0598939 + t * (0.0061966 - t * 0.000197)));
  }
  if (y < 1941.0) {
    const double t = y - 1920.0;
    return 21.20 + t * (0.84493 + t * (-0.076100 + t * 0.0020936));
  }
  if (y < 1961.0) {
    const double t = y - 1950.0;
    return 29.07 + t * (0.407 + t * (-1.0 / 233.0 + t / 2547.0));
  }
  if (y < 2050.0) {
    const double t = y - 2000.0;
    return 62.92 + t * (0.32217 + t * 0.005589);
  }
  const double u = (y - 1820.0) / 100.0;
  return -20.0 + 32.0 * u * u - 0.5628 * (2150.0 - y);
}

double JulianYear(int modified_julian_day, double second_of_day) {
  return 2000.0 + (modified_julian_day - 51544.5 + second_of_day / kSecondsPerDay) / 365.25;
}

}  // namespace

UtcTime Now() {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const sys_days day = std::chrono::floor<days>(now);
  return {static_cast<int>(day.time_since_epoch().count()) + kUnixEpoch,
          std::chrono::duration<double>(now - day).count()};
}

UtcTime MeanSolarMidnight(const Place& place, const UtcTime& around) {
  const double ahead_s = WrappedLongitude(place.longitude_deg) / 360.0 * kDay_s;  // of Greenwich
  const double local_day = std::floor((around.second_of_day + ahead_s) / kDay_s);
  const int day = around.modified_julian_day + static_cast<int>(local_day);
  return AddSeconds(UtcTime{day, 0.0}, -ahead_s);
}

UtcTime ParseInstant(std::string_view text, const std::optional<std::string>& zone) {
  InstantReader reader(text);
  const WrittenTime written = reader.Read();
  if (!written.offset && !zone) {
    reader.Refuse("it needs Z, an offset such as +09:00, or a time zone");
  }
  const sys_seconds utc =
      written.second -
      (written.offset ? *written.offset : OffsetInZone(reader, written.second, *zone));
  const sys_days day = std::chrono::floor<days>(utc);
  const int year = static_cast<int>(std::chrono::year_month_day(day).year());
  if (year < kFirstYear || year > kLastYear) {
    reader.Refuse(
        fmt::format("its year of UTC is {}; it must lie in [{}, {}]", year, kFirstYear, kLastYear));
  }
  UtcTime instant{static_cast<int>(day.time_since_epoch().count()) + kUnixEpoch,
                  static_cast<double>((utc - day).count()) + written.fraction};
  if (written.is_leap_second) {
    if ((utc - day).count() != kDay_s - 1 || DayLength(instant.modified_julian_day) <= kDay_s) {
      reader.Refuse("there is no leap second; the second must lie in [0, 59]");
    }
    instant.second_of_day += 1.0;
  }
  return instant;
}

std::string FormatUtc(const UtcTime& instant, int decimals) {
  return Formatted(instant, decimals, nullptr);
}

std::string FormatInZone(const UtcTime& instant, const std::string& zone) {
  const TimeZone found(zone);
  return Formatted(instant, 0, &found);
}

UtcTime AddSeconds(const UtcTime& instant, double seconds) {
  if (seconds == 0.0) return instant;  // an instant inside a leap second is preserved
  constexpr double kMost_s = 1e12;     // 30,000 years: days fit an int, seconds are precise to 1e-4
  RequireInRange(seconds, -kMost_s, kMost_s, "seconds");
  const double step_days = std::floor(seconds / kDay_s);
  const double total_s = instant.second_of_day + (seconds - step_days * kDay_s);
  const double carry_days = std::floor(total_s / kDay_s);
  return {instant.modified_julian_day + static_cast<int>(step_days + carry_days),
          total_s - carry_days * kDay_s};
}

double SecondsBetween(const UtcTime& from, const UtcTime& to) {
  return static_cast<double>(kDay_s) * (to.modified_julian_day - from.modified_julian_day) +
         (to.second_of_day - from.second_of_day);
}

double ParseDuration(std::string_view text) {
  const auto refuse = [&] {
    throw InputError(fmt::format(
        "duration \"{}\": it must be numbers with the units d, h, m, s in this order, as 1h30m",
        text));
  };
  constexpr std::array<std::pair<char, double>, 4> kUnits = {
      {{'d', kSecondsPerDay}, {'h', 3600.0}, {'m', 60.0}, {'s', 1.0}}};
  TextCursor cursor(text);
  const bool negative = cursor.Accept('-');
  if (!negative) cursor.Accept('+');
  if (cursor.AtEnd()) refuse();
  double total_s = 0.0;
  auto unit = kUnits.begin();
  while (!cursor.AtEnd()) {
    const std::string_view digits = cursor.Run("0123456789.");
    double value = 0.0;
    const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                              std::chars_format::fixed);
    if (fault != std::errc() || end != digits.data() + digits.size()) refuse();
    unit = std::find_if(unit, kUnits.end(),
                        [&](const auto& candidate) { return cursor.Accept(candidate.first); });
    if (unit == kUnits.end()) refuse();
    total_s += value * (unit++)->second;
  }
  return negative ? -total_s : total_s;
}

double DayLength(int modified_julian_day) {
  if (modified_julian_day < kFirstDayOfLeapSeconds || modified_julian_day >= kFirstDayUnknown) {
    return kSecondsPerDay;
  }
  const double step_s =
      TtMinusUtc(modified_julian_day + 1, 0.0) - TtMinusUtc(modified_julian_day, 0.0);
  return step_s > 0.5 ? kSecondsPerDay + 1.0 : kSecondsPerDay;
}

double DeltaT(const UtcTime& instant) {
  const int day = instant.modified_julian_day;
  if (day >= kFirstDayOfUtc && day < kFirstDayUnknown) {
    return TtMinusUtc(day, instant.second_of_day);
  }
  const double year = JulianYear(day, instant.second_of_day);
  const int seam_day = day < kFirstDayOfUtc ? kFirstDayOfUtc : kFirstDayUnknown;
  const double seam_year = JulianYear(seam_day, 0.0);
  const double gap_s = (day < kFirstDayOfUtc ? TtMinusUtc(seam_day, 0.0)
                                             : TtMinusUtc(seam_day - 1, kSecondsPerDay)) -
                       EspenakMeeus(seam_year);
  // Before 1960 the polynomials represent observations: the gap (0.03 s) fades within ten years. In
  // 2027 they are a forecast that is 6 s too high; there is no indication that the earth's rotation
  // will catch up, so the gap remains.
  const double share =
      day < kFirstDayOfUtc ? std::clamp(1.0 - (seam_year - year) / 10.0, 0.0, 1.0) : 1.0;
  return EspenakMeeus(year) + share * gap_s;
}

}  // namespace alpenglow::atmosphere
