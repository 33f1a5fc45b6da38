// SPDX-License-Identifier: MIT
#include "atmosphere/time_place/time_zone.h"

#include <date/tz.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"

namespace alpenglow::atmosphere {
namespace {

using std::chrono::seconds;

bool SkipName(TextCursor& cursor) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  constexpr std::string_view kQuoted =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-";
  if (cursor.Accept('<')) return cursor.Run(kQuoted).size() >= 3 && cursor.Accept('>');
  return cursor.Run(kLetters).size() >= 3;
}

/// Reads "[+-]hh[:mm[:ss]]"; hours up to 167 as RFC 8536 allows.
std::optional<seconds> ReadTime(TextCursor& cursor) {
  const bool negative = cursor.Accept('-');
  if (!negative) cursor.Accept('+');
  int total_s = 0;
  for (const int unit_s : {3600, 60, 1}) {
    if (unit_s != 3600 && !cursor.Accept(':')) break;
    const std::optional<int> value = cursor.Number(1, 3);
    if (!value) return std::nullopt;
    total_s += *value * unit_s;
  }
  return seconds(negative ? -total_s : total_s);
}

/// Reads ",Mm.w.d[/time]".
std::optional<YearlyChange> ReadChange(TextCursor& cursor) {
  if (!cursor.Accept(',') || !cursor.Accept('M')) return std::nullopt;
  const std::optional<int> month = cursor.Number(1, 2);
  if (!month || *month < 1 || *month > 12 || !cursor.Accept('.')) return std::nullopt;
  const std::optional<int> week = cursor.Number(1, 1);
  if (!week || *week < 1 || *week > 5 || !cursor.Accept('.')) return std::nullopt;
  const std::optional<int> weekday = cursor.Number(1, 1);
  if (!weekday || *weekday > 6) return std::nullopt;
  std::optional<seconds> time = std::chrono::hours(2);
  if (cursor.Accept('/')) time = ReadTime(cursor);
  if (!time) return std::nullopt;
  return YearlyChange{static_cast<unsigned>(*month), static_cast<unsigned>(*week),
                      static_cast<unsigned>(*weekday), *time};
}

std::chrono::sys_seconds InstantOf(const YearlyChange& change, std::chrono::year year,
                                   seconds offset_before) {
  const std::chrono::month month(change.month);
  const std::chrono::weekday weekday(change.weekday);
  const std::chrono::sys_days day =
      change.week == 5 ? std::chrono::sys_days(year / month / weekday[std::chrono::last])
                       : std::chrono::sys_days(year / month / weekday[change.week]);
  return std::chrono::sys_seconds(day) + change.time - offset_before;
}

using std::chrono::seconds;
using std::chrono::sys_seconds;

const date::time_zone* Located(const std::string& name) {
  try {
    return date::locate_zone(name);
  } catch (const std::runtime_error&) {
    throw InputError(fmt::format(
        "zone \"{}\" is not in the time zone database; it must be a name such as Europe/Zurich",
        name));
  }
}

/// Returns the last line of the zone's file. The date library reads only the table of changes,
/// which ends in 2037, and would keep winter time ever after.
std::optional<PosixZoneRule> LastRule(const std::string& name) {
  // These are the folders in which the date library searches.
  for (const char* folder : {"/usr/share/zoneinfo/", "/var/db/zoneinfo/"}) {
    std::ifstream file(folder + name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.size() < 2 || text.back() != '\n') continue;
    const std::size_t line = text.rfind('\n', text.size() - 2);
    if (line == std::string::npos) continue;
    return ParsePosixZoneRule(std::string_view(text).substr(line + 1, text.size() - line - 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<PosixZoneRule> ParsePosixZoneRule(std::string_view text) {
  TextCursor cursor(text);
  if (!SkipName(cursor)) return std::nullopt;
  const std::optional<seconds> west = ReadTime(cursor);  // POSIX counts westward
  if (!west) return std::nullopt;
  PosixZoneRule rule{-*west, std::nullopt};
  if (cursor.AtEnd()) return rule;
  if (!SkipName(cursor)) return std::nullopt;
  seconds offset = rule.standard_offset + std::chrono::hours(1);
  if (!cursor.rest().starts_with(',')) {
    const std::optional<seconds> daylight_west = ReadTime(cursor);
    if (!daylight_west) return std::nullopt;
    offset = -*daylight_west;
  }
  const std::optional<YearlyChange> start = ReadChange(cursor);
  if (!start) return std::nullopt;
  const std::optional<YearlyChange> end = ReadChange(cursor);
  if (!end || !cursor.AtEnd()) return std::nullopt;
  rule.daylight = DaylightTime{offset, *start, *end};
  return rule;
}

seconds OffsetAt(const PosixZoneRule& rule, std::chrono::sys_seconds instant) {
  if (!rule.daylight) return rule.standard_offset;
  const std::chrono::year year = std::chrono::year_month_day(std::chrono::floor<std::chrono::days>(
                                                                 instant + rule.standard_offset))
                                     .year();
  const auto start = InstantOf(rule.daylight->start, year, rule.standard_offset);
  const auto end = InstantOf(rule.daylight->end, year, rule.daylight->offset);
  const bool is_daylight = start < end ? (start <= instant && instant < end)
                                       : !(end <= instant && instant < start);  // southern summer
  return is_daylight ? rule.daylight->offset : rule.standard_offset;
}

TimeZone::TimeZone(const std::string& name)
    : zone_(Located(name)), last_rule_(LastRule(zone_->name())) {}

seconds TimeZone::OffsetAt(sys_seconds instant) const {
  const date::sys_info info = zone_->get_info(instant);
  // The library represents an unlimited period by an end in the year 32767.
  const bool is_last =
      info.end > sys_seconds(std::chrono::sys_days(std::chrono::year(3000) / 1 / 1));
  return is_last && last_rule_ ? atmosphere::OffsetAt(*last_rule_, instant) : info.offset;
}

std::vector<seconds> TimeZone::OffsetsOf(sys_seconds local) const {
  // Every applicable offset is in force within a day of UTC = local: offsets are less than a day,
  // and two changes are further apart.
  std::vector<seconds> found;
  for (const seconds shift : {-seconds(86400), seconds(86400)}) {
    const seconds offset = OffsetAt(local + shift);
    if (OffsetAt(local - offset) == offset &&
        std::find(found.begin(), found.end(), offset) == found.end()) {
      found.push_back(offset);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace alpenglow::atmosphere
