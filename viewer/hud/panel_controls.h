// SPDX-License-Identifier: MIT
// Controls of the panels: each returns the user's choice in this frame, if any.
//
// DayStrip shows the colours of the sky through one day; a click on it chooses the time. Columns
// are instants, rows are elevations above the horizon under the sun, the zenith on top. The light
// is computed by SingleScattering and MultipleScattering, without a moon. The exposure of each
// column lies between its metered exposure and that of a bright day, so that night is dark while
// dusk shows its colours:
//
//   EV = 0.8 EV(meter, mean luminance of the column) + 0.2 EV 14
//
// PlaceSearch lists the named places and filters them while typing.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

struct DayStripRequest {
  std::shared_ptr<const MultipleScattering> multiple_scattering;  // not null
  GeodeticPosition place;
  UtcInstant begin;  // start of the 24 hours shown
  int columns = 96;  // >= 2
};

struct DayStrip {
  int columns = 0, rows = 0;
  /// Display codes in [0, 1], row by row, the zenith first.
  std::vector<std::array<float, 3>> colours;
  std::vector<double> sun_elevation_rad;  // apparent, one per column
  UtcInstant begin;

  [[nodiscard]] const std::array<float, 3>& at(int column, int row) const {
    return colours[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};

/// Returns a strip in which column i shows the instant begin + (i + 1/2) / columns of 24 hours.
[[nodiscard]] DayStrip MakeDayStrip(const DayStripRequest& request);

/// Returns whether strips look the same: they have the same air, and begin within a second, and
/// their places differ by less than half a degree and, in height, by less than a tenth or 200 m.
[[nodiscard]] bool LooksTheSame(const DayStripRequest& a, const DayStripRequest& b);

struct SliderRange {
  double low, high;
  const char* format;  // in Dear ImGui's notation, "%.0f km"
  bool logarithmic = false;
};

[[nodiscard]] std::optional<double> Slider(const char* label, double value,
                                           const SliderRange& range);
/// Draws a list and returns the chosen name.
[[nodiscard]] std::optional<std::string> NameList(const char* label, const std::string& current,
                                                  std::span<const std::string> names);
[[nodiscard]] std::optional<bool> CheckBox(const char* label, bool is_on);

/// Draws buttons in rows of the panel's width and returns the index of the pressed one.
[[nodiscard]] std::optional<std::size_t> ButtonRows(std::span<const std::string> names,
                                                    double row_width_px);

struct StripLook {
  double width_px, height_px;
  double brightness = 1.0;  // factor on the displayed colours
};

/// Draws the colours of the day, its hours and the path of the sun; returns the clicked fraction of
/// the day. Without a strip its space stays empty.
[[nodiscard]] std::optional<double> DayStripControl(const DayStrip* strip, double day_fraction,
                                                    const StripLook& look);

/// Draws a field for a part of a name and the list of matching places, the best match first and
/// equal matches by name (PlacesByName, places.h), into the current Dear ImGui window.
/// @return  the name of the clicked place, or of the first one when Enter was pressed.
[[nodiscard]] std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px);

}  // namespace alpenglow::viewer
