// SPDX-License-Identifier: MIT
// What sun and moon do at a place, day by day: `skyseries times`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "renderer/series/time_text.h"

namespace alpenglow {

/// The events of a day in the order of its columns.
inline constexpr std::array<const char*, 12> kTimesOfDay{
    "astronomical-dawn", "nautical-dawn", "civil-dawn",
    "sunrise",           "noon",          "sunset",
    "civil-dusk",        "nautical-dusk", "astronomical-dusk",
    "moonrise",          "moon-transit",  "moonset"};

/// Sun and moon of a day at a place.
struct DayTimes {
  std::string date;
  std::array<std::optional<UtcInstant>, kTimesOfDay.size()> at;  // those that happen
  double noon_elevation_deg;  // of the sun's centre in the meridian, refracted
  double moon_illuminated;    // share of the disk at that noon, [0, 1]
};

/// Days from that of `first.around` on. Throws InputError when that is not given.
/// @param count  1 at least.
[[nodiscard]] std::vector<DayTimes> TimesOfDays(const EventDay& first, int count);

/// A table for people: hours and minutes of the zone, of UTC without one, rounded to the minute,
/// "--:--" for what does not happen; each line ends.
[[nodiscard]] std::string TableOf(const std::vector<DayTimes>& days,
                                  const std::optional<std::string>& zone);

/// CSV with a header: date, the events as instants of UTC to the second (empty where there are
/// none), noon_elevation_deg, moon_illuminated.
[[nodiscard]] std::string CsvOf(const std::vector<DayTimes>& days);

}  // namespace alpenglow
