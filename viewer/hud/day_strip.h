// SPDX-License-Identifier: MIT
// DayStrip: the colours of the sky through one day.
//
// Columns are instants, rows are elevations above the horizon under the sun, the zenith on top. The
// light is computed by SingleScattering and MultipleScattering, without a moon. The exposure of each
// column lies between its metered exposure and that of a bright day, so that night is dark while
// dusk shows its colours:
//
//   EV = 0.8 EV(meter, mean luminance of the column) + 0.2 EV 14
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

struct DayStripRequest {
  std::shared_ptr<const MultipleScattering> multiple_scattering;  // not null
  Place place;
  UtcTime begin;     // start of the 24 hours shown
  int columns = 96;  // >= 2
};

struct DayStrip {
  int columns = 0, rows = 0;
  /// Display codes in [0, 1], row by row, the zenith first.
  std::vector<std::array<float, 3>> colours;
  std::vector<double> sun_elevation_rad;  // apparent, one per column
  UtcTime begin;

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

}  // namespace alpenglow::viewer
