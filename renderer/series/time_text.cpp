// SPDX-License-Identifier: MIT
#include "renderer/series/time_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/eclipse.h"
#include "atmosphere/sun/moon.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"
#include "atmosphere/text/toml_table.h"

namespace alpenglow {
namespace {

constexpr double kSecondsPerDay = 86400.0;
constexpr std::size_t kDateLength = 10;  // "2026-06-21"

constexpr std::array<std::pair<std::string_view, int>, 3> kDayWords = {
    {{"yesterday", -1}, {"today", 0}, {"tomorrow", 1}}};

const std::vector<std::string> kEventNames = {
    "noon",          "sunrise",           "sunset",
    "civil-dawn",    "civil-dusk",        "nautical-dawn",
    "nautical-dusk", "astronomical-dawn", "astronomical-dusk",
    "moonrise",      "moonset",           "moon-transit",
    "first-contact", "second-contact",    "eclipse-maximum",
    "third-contact", "last-contact",      "now"};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

struct EventText {
  std::string_view name;    // "civil-dusk"
  std::string_view offset;  // "+20m", or nothing
};

/// Cut at the last sign that a digit follows: names have signs too, but no digits.
EventText SplitEvent(std::string_view text) {
  for (std::size_t i = text.size(); i-- > 0;) {
    const bool sign = text[i] == '+' || text[i] == '-';
    if (sign && i + 1 < text.size() && IsDigit(text[i + 1])) {
      return {text.substr(0, i), text.substr(i)};
    }
  }
  return {text, {}};
}

double OffsetOf(const EventText& parts) {
  return parts.offset.empty() ? 0.0 : ParseDuration(parts.offset);
}

bool IsNow(std::string_view text) { return SplitEvent(text).name == "now"; }

std::optional<int> DaysFromToday(std::string_view word) {
  for (const auto& [name, days] : kDayWords) {
    if (name == word) return days;
  }
  return std::nullopt;
}

bool IsClockTime(std::string_view text) {
  return text.size() >= 5 && IsDigit(text[0]) && IsDigit(text[1]) && text[2] == ':';
}

[[noreturn]] void RefuseEvent(std::string_view name, std::string_view text) {
  const std::optional<std::string> nearest = NearestName(name, kEventNames);
  throw InputError(fmt::format("time \"{}\": unknown event \"{}\"; {}", text, name,
                               nearest
                                   ? fmt::format("did you mean {}?", *nearest)
                                   : fmt::format("known are {}", fmt::join(kEventNames, ", "))));
}

const UtcInstant& AroundOf(std::string_view text, const EventDay& day) {
  if (!day.around) throw InputError(fmt::format("time \"{}\": of which day? give a date", text));
  return *day.around;
}

/// Where the time begins in "tomorrow 18:30" and "2026-06-21 sunrise"; nothing where no day is
/// before it, or only digits of an instant that ParseInstant reads.
std::optional<std::size_t> EndOfDay(std::string_view text) {
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos || space + 1 == text.size()) return std::nullopt;
  const bool is_instant = IsDigit(text[0]) && IsDigit(text[space + 1]);
  if (is_instant || !IsDayText(text.substr(0, space))) return std::nullopt;
  return space;
}

/// The event that clocks of the place show on the date of `around`. Each comes 50 minutes later from
/// day to day: once a month there is none.
std::optional<UtcInstant> FindMoonEvent(MoonEvent event, const UtcInstant& around,
                                        const EventDay& day) {
  constexpr double kBefore_s = 1.5 * kSecondsPerDay;  // the date may have begun a day before
  const std::string date = DateAt(around, day);
  UtcInstant after = AddSeconds(around, -kBefore_s);
  while (true) {
    const std::optional<UtcInstant> next = NextMoonEvent(event, day.place, after);
    if (!next || DateAt(*next, day) > date) return std::nullopt;
    if (DateAt(*next, day) == date) return next;
    after = AddSeconds(*next, 1.0);
  }
}

std::optional<UtcInstant> FindEclipseEvent(EclipseEvent event, const UtcInstant& around,
                                           const EventDay& day) {
  const UtcInstant midnight = MeanSolarMidnight(WrappedLongitude(day.place.longitude_rad), around);
  const auto eclipse = FindSolarEclipse(day.place, midnight, kSecondsPerDay);
  return eclipse ? InstantOf(event, *eclipse) : std::nullopt;
}

std::string NoSuchEvent(std::string_view text, const EventDay& day) {
  const EventText parts = SplitEvent(text);
  std::string fault =
      fmt::format("time \"{}\": there is no {} on {} at latitude {:.4f}, longitude {:.4f}", text,
                  parts.name, DateAt(*day.around, day), day.place.latitude_rad / kRadiansPerDegree,
                  day.place.longitude_rad / kRadiansPerDegree);
  if (EclipseEventFromName(parts.name)) return fault + ": no such eclipse of the sun";
  const std::optional<MoonEvent> moon = MoonEventFromName(parts.name);
  if (!moon) return fault + " (polar day or night)";
  if (const auto next = NextMoonEvent(*moon, day.place, *day.around)) {
    fault += fmt::format(" (the next is at {})", FormatUtc(*next));
  }
  return fault;
}

}  // namespace

std::string DateAt(const UtcInstant& instant, const EventDay& day) {
  if (day.zone) return FormatInZone(instant, *day.zone).substr(0, kDateLength);
  const double turns = WrappedLongitude(day.place.longitude_rad) / (2.0 * kPi);
  return FormatUtc(AddSeconds(instant, kSecondsPerDay * turns)).substr(0, kDateLength);
}

UtcInstant DayFromText(std::string_view date, const EventDay& day) {
  if (const std::optional<int> days = DaysFromToday(date)) {
    const UtcInstant noon_today = DayFromText(DateAt(day.now, day), day);
    const UtcInstant near_noon = AddSeconds(noon_today, *days * kSecondsPerDay);
    return DayFromText(DateAt(near_noon, day), day);  // clocks may have been set in between
  }
  if (date.size() != kDateLength) {
    throw InputError(
        fmt::format("date is \"{}\"; write it as 2026-06-21, today, tomorrow or yesterday", date));
  }
  const std::string noon = fmt::format("{}T12:00:00", date);
  if (day.zone) return ParseInstant(noon, day.zone);
  const double turns = WrappedLongitude(day.place.longitude_rad) / (2.0 * kPi);
  return AddSeconds(ParseInstant(noon + "Z"), -kSecondsPerDay * turns);
}

bool IsDayText(std::string_view text) {
  return DaysFromToday(text).has_value() ||
         (text.size() == kDateLength && IsDigit(text[0]) && text[4] == '-' && text[7] == '-');
}

TimeOfDay TimeOfDayFromText(std::string_view text, const EventDay& day) {
  TimeOfDay time{std::string(text), day};
  if (const std::optional<std::size_t> end = EndOfDay(text)) {
    time.text = text.substr(*end + 1);
    time.day.around = DayFromText(text.substr(0, *end), day);
  }
  return time;
}

bool IsDailyEvent(std::string_view text) {
  return !text.empty() && !IsDigit(text.front()) && !IsNow(text) && !IsDayText(text) &&
         !EndOfDay(text);
}

std::optional<UtcInstant> FindDailyEvent(std::string_view text, const EventDay& day) {
  const EventText parts = SplitEvent(text);
  const double offset_s = OffsetOf(parts);
  std::optional<UtcInstant> instant;
  if (const std::optional<SunEvent> sun = SunEventFromName(parts.name)) {
    instant = FindSunEvent(*sun, day.place, AroundOf(text, day));
  } else if (const std::optional<MoonEvent> moon = MoonEventFromName(parts.name)) {
    instant = FindMoonEvent(*moon, AroundOf(text, day), day);
  } else if (const std::optional<EclipseEvent> eclipse = EclipseEventFromName(parts.name)) {
    instant = FindEclipseEvent(*eclipse, AroundOf(text, day), day);
  } else {
    RefuseEvent(parts.name, text);
  }
  if (instant) instant = AddSeconds(*instant, offset_s);
  return instant;
}

UtcInstant InstantFromText(std::string_view text, const EventDay& day) {
  if (IsNow(text)) return AddSeconds(day.now, OffsetOf(SplitEvent(text)));
  if (EndOfDay(text)) {
    const TimeOfDay time = TimeOfDayFromText(text, day);
    return InstantFromText(time.text, time.day);
  }
  if (IsDayText(text)) {
    throw InputError(fmt::format(
        "time \"{0}\": at what time of that day? write \"{0} 18:30\" or \"{0} sunrise\"", text));
  }
  if (IsClockTime(text)) {
    return ParseInstant(fmt::format("{}T{}", DateAt(AroundOf(text, day), day), text), day.zone);
  }
  if (!IsDailyEvent(text)) return ParseInstant(text, day.zone);
  const std::optional<UtcInstant> instant = FindDailyEvent(text, day);
  if (!instant) throw InputError(NoSuchEvent(text, day));
  return *instant;
}

}  // namespace alpenglow
