// SPDX-License-Identifier: MIT
// What sun and moon do at a place, day by day: `skyseries times`.
//
// Sun, moon, light and exposure of a series over its time, as a plot (SVG).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/eclipse.h"
#include "atmosphere/sun/time.h"
#include "renderer/layer.h"
#include "renderer/series/time_text.h"

namespace alpenglow::renderer {

/// The events of a day in the order of its columns.
inline constexpr std::array<const char*, 12> kTimesOfDay{
    "astronomical-dawn", "nautical-dawn", "civil-dawn",
    "sunrise",           "noon",          "sunset",
    "civil-dusk",        "nautical-dusk", "astronomical-dusk",
    "moonrise",          "moon-transit",  "moonset"};

/// An eclipse of the sun where some of it is seen.
struct SeenEclipse {
  SolarEclipse whole;               // whether or not the sun is up
  SolarEclipse::Moment at_deepest;  // that is seen: the maximum, or sunrise or sunset
};

/// Sun and moon of a day at a place.
struct DayTimes {
  std::string date;
  std::array<std::optional<UtcInstant>, kTimesOfDay.size()> at;  // those that happen
  double noon_elevation_deg;  // of the sun's centre in the meridian, refracted
  double moon_illuminated;    // share of the disk at that noon, [0, 1]
  std::optional<SeenEclipse> eclipse = std::nullopt;
};

/// Days from that of `first.around` on. Throws InputError when that is not given.
/// @param count  1 at least.
[[nodiscard]] std::vector<DayTimes> TimesOfDays(const EventDay& first, int count);

/// A table for people: hours and minutes of the zone, of UTC without one, rounded to the minute,
/// "--:--" for what does not happen; each line ends. An eclipse has a line under its day, to the
/// second.
[[nodiscard]] std::string TableOf(const std::vector<DayTimes>& days,
                                  const std::optional<std::string>& zone);

/// CSV with a header: date, the events as instants of UTC to the second (empty where there are
/// none), noon_elevation_deg, moon_illuminated; and of an eclipse that is seen eclipse_first_contact,
/// eclipse_second_contact, eclipse_deepest, eclipse_third_contact, eclipse_last_contact (empty while
/// the sun is down), eclipse_magnitude (share of the diameter) and eclipse_obscuration (of the area),
/// both at the deepest that is seen.
[[nodiscard]] std::string CsvOf(const std::vector<DayTimes>& days);

/// What a plot says of a frame.
struct PlottedMoment {
  UtcInstant instant;
  double sun_elevation_deg = 0.0, moon_elevation_deg = 0.0;  // without refraction
  std::optional<double> illuminance_lx = {};                 // of sky and lights on level ground
  std::optional<double> ev100 = {};
};

/// An illuminance that others published, drawn across its panel.
struct LightLevel {
  const char* name;
  double low_lx, high_lx;
};

/// Of level ground under clear skies. Full moon, high: Kyba, Mohar, Posch (2017), Astronomy &
/// Geophysics 58, 1.31; ends of twilights and the night without moon: RCA Electro-Optics Handbook
/// (1974), section 6.
[[nodiscard]] const std::vector<LightLevel>& PublishedLightLevels();

/// Three panels over one axis of time, of the zone or of UTC: elevations, with bands of twilight
/// behind them; illuminance by its logarithm (what is under 1e-5 lx is left out); EV100. Curves have
/// gaps where frames have no value. Throws InternalError for no moments; they must not go back in
/// time.
[[nodiscard]] std::string SvgOfDay(const std::vector<PlottedMoment>& moments,
                                   const std::optional<std::string>& zone,
                                   const std::vector<LightLevel>& levels = {});

}  // namespace alpenglow::renderer
