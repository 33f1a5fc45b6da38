// SPDX-License-Identifier: MIT
// Times of sun and moon at a place, day by day (`skyseries times`).
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/astronomy/time_text.h"
#include "atmosphere/time_place/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Events of a day in the order of the columns.
inline constexpr std::array<const char*, 12> kTimesOfDay{
    "astronomical-dawn", "nautical-dawn", "civil-dawn",
    "sunrise",           "noon",          "sunset",
    "civil-dusk",        "nautical-dusk", "astronomical-dusk",
    "moonrise",          "moon-transit",  "moonset"};

/// A solar eclipse of which at least a part is visible.
struct SeenEclipse {
  SolarEclipse whole;               // all contacts, including those with the sun down
  SolarEclipse::Moment at_deepest;  // deepest visible moment: the maximum, or sunrise or sunset
};

/// Sun and moon of a day at a place.
struct DayTimes {
  std::string date;
  std::array<std::optional<UtcTime>, kTimesOfDay.size()> at;  // empty for events that do not happen
  double noon_elevation_deg;  // refracted elevation of the sun's centre in the meridian
  double moon_illuminated;    // illuminated fraction of the disk at that noon, [0, 1]
  std::optional<SeenEclipse> eclipse = std::nullopt;
};

/// Computes the times of consecutive days, starting with the day of `first.around`, and passes each
/// day to `visit` as soon as it is known. Throws InputError if the first day is not given; a signal
/// stops it between days (ThrowIfInterrupted).
/// @param count  at least 1.
void VisitTimesOfDays(const EventDay& first, int count,
                      const std::function<void(const DayTimes&)>& visit);

/// Returns the head of a text table, and the lines of a day: hours and minutes in the zone, or in
/// UTC without one, rounded to the minute, "--:--" for events that do not happen; each line ends
/// with a newline. An eclipse has a line under its day, to the second.
[[nodiscard]] std::string HeadOfTable(const std::optional<std::string>& zone);
[[nodiscard]] std::string LinesOf(const DayTimes& day, const std::optional<std::string>& zone);

/// Returns the header of a CSV, and the line of a day: date, the events as instants of UTC to the
/// second (empty where there are none), noon_elevation_deg, moon_illuminated; and for a visible
/// eclipse eclipse_first_contact, eclipse_second_contact, eclipse_deepest, eclipse_third_contact,
/// eclipse_last_contact (empty while the sun is down), eclipse_magnitude (fraction of the diameter)
/// and eclipse_obscuration (fraction of the area), both at the deepest visible moment.
[[nodiscard]] std::string HeaderOfTimesCsv();
[[nodiscard]] std::string CsvLineOf(const DayTimes& day);

}  // namespace alpenglow::renderer
