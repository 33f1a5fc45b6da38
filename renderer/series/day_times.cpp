// SPDX-License-Identifier: MIT
#include "renderer/series/day_times.h"

#include <fmt/format.h>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/moon.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"

namespace alpenglow {
namespace {

constexpr double kDay_s = 86400.0;
// Of the table's columns, two lines of words over each.
constexpr std::array<std::array<const char*, 2>, kTimesOfDay.size()> kHeads{{{"astr.", "dawn"},
                                                                             {"naut.", "dawn"},
                                                                             {"civil", "dawn"},
                                                                             {"sun", "rise"},
                                                                             {"", "noon"},
                                                                             {"sun", "set"},
                                                                             {"civil", "dusk"},
                                                                             {"naut.", "dusk"},
                                                                             {"astr.", "dusk"},
                                                                             {"moon", "rise"},
                                                                             {"moon", "tran."},
                                                                             {"moon", "set"}}};

DayTimes TimesOf(const EventDay& day) {
  DayTimes times;
  times.date = DateAt(*day.around, day);
  for (std::size_t i = 0; i < kTimesOfDay.size(); ++i) {
    times.at[i] = FindDailyEvent(kTimesOfDay[i], day);
  }
  const UtcInstant noon = *FindSunEvent(SunEvent::kNoon, day.place, *day.around);
  times.noon_elevation_deg = ApparentSunAt(day.place, noon).elevation_rad / kRadiansPerDegree;
  times.moon_illuminated = MoonAt(day.place, noon).IlluminatedFraction();
  return times;
}

/// "04:25", of the zone or of UTC.
std::string ClockTime(const std::optional<UtcInstant>& instant,
                      const std::optional<std::string>& zone) {
  if (!instant) return "--:--";
  constexpr double kHalfMinute_s = 30.0;
  const UtcInstant rounded = AddSeconds(*instant, kHalfMinute_s);
  return (zone ? FormatInZone(rounded, *zone) : FormatUtc(rounded)).substr(11, 5);
}

}  // namespace

std::vector<DayTimes> TimesOfDays(const EventDay& first, int count) {
  if (!first.around) throw InputError("times of which days? give a date");
  std::vector<DayTimes> days;
  for (int i = 0; i < count; ++i) {
    EventDay day = first;
    day.around = AddSeconds(*first.around, i * kDay_s);
    days.push_back(TimesOf(day));
  }
  return days;
}

std::string TableOf(const std::vector<DayTimes>& days, const std::optional<std::string>& zone) {
  std::string text;
  for (std::size_t line = 0; line < 2; ++line) {
    text += fmt::format("{:<10}", line == 0 ? "" : zone.value_or("UTC").substr(0, 10));
    for (const auto& head : kHeads) text += fmt::format(" {:>5}", head[line]);
    text += line == 0 ? "  noon  moon\n" : "   sun   lit\n";
  }
  for (const DayTimes& day : days) {
    text += day.date;
    for (const auto& instant : day.at) text += fmt::format(" {}", ClockTime(instant, zone));
    text +=
        fmt::format(" {:5.1f} {:4.0f}%\n", day.noon_elevation_deg, 100.0 * day.moon_illuminated);
  }
  return text;
}

std::string CsvOf(const std::vector<DayTimes>& days) {
  std::string text =
      fmt::format("date,{},noon_elevation_deg,moon_illuminated\n", fmt::join(kTimesOfDay, ","));
  for (const DayTimes& day : days) {
    text += day.date;
    for (const auto& instant : day.at)
      text += fmt::format(",{}", instant ? FormatUtc(*instant) : "");
    text += fmt::format(",{:.3f},{:.4f}\n", day.noon_elevation_deg, day.moon_illuminated);
  }
  return text;
}

}  // namespace alpenglow
