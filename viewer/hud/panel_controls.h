// SPDX-License-Identifier: MIT
// The colours of the sky through one day: what a pilot clicks on to choose the time.
//
// Columns are instants, rows elevations over the horizon under the sun, the zenith above. Light
// by AirIntegrator and DiffuseLight, without a moon. Each column is exposed between what a meter
// would pick for it and a bright day, so that night is dark and yet dusk shows its colours:
//
//   EV = 0.8 EV(meter, mean luminance of the column) + 0.2 EV 14
//
// Controls that panels are made of: each tells what was chosen in this frame, if anything.
//
// The places that have names, in a list that typing makes shorter.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "lut/diffuse/multiple_scattering.h"
#include "viewer/job/latest_job.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

struct DayStripRequest {
  std::shared_ptr<const AirIntegrator<float>> air;  // not null; of one medium with `diffuse`
  std::shared_ptr<const DiffuseLight> diffuse;      // not null
  GeodeticPosition place;
  UtcInstant begin;  // of the 24 hours shown
  int columns = 96;  // >= 2
};

struct DayStrip {
  int columns = 0, rows = 0;
  /// Codes of the display in [0, 1], row by row, the zenith first.
  std::vector<std::array<float, 3>> colours;
  std::vector<double> sun_elevation_rad;  // apparent, a column
  UtcInstant begin;

  [[nodiscard]] const std::array<float, 3>& at(int column, int row) const {
    return colours[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};

/// Column i shows the instant begin + (i + 1/2) / columns of 24 hours.
[[nodiscard]] DayStrip MakeDayStrip(const DayStripRequest& request);

/// Strips made on a thread of their own, redone when what they show has changed enough to be seen:
/// the air, the day, or the place by more than half a degree or a tenth of its height.
class DayStrips {
 public:
  DayStrips() : job_(MakeDayStrip) {}
  void Want(const DayStripRequest& request);
  /// The newest; null until there is one. Throws what making it threw.
  [[nodiscard]] const DayStrip* Newest();
  [[nodiscard]] bool Busy() const { return job_.Busy(); }
  /// Waits for what was wanted last.
  void Wait() { job_.Wait(); }

 private:
  std::optional<DayStripRequest> asked_;
  std::optional<DayStrip> newest_;
  LatestJob<DayStripRequest, DayStrip> job_;
};

struct SliderRange {
  double low, high;
  const char* format;  // as Dear ImGui wants it, "%.0f km"
  bool logarithmic = false;
};

[[nodiscard]] std::optional<double> Slider(const char* label, double value,
                                           const SliderRange& range);
/// One of some names.
[[nodiscard]] std::optional<std::string> NameList(const char* label, const std::string& current,
                                                  std::span<const std::string> names);
[[nodiscard]] std::optional<bool> CheckBox(const char* label, bool is_on);

/// Buttons in rows as wide as the panel: the one that was pressed.
[[nodiscard]] std::optional<std::size_t> ButtonRows(std::span<const std::string> names,
                                                    double row_width_px);

struct StripLook {
  double width_px, height_px;
  double brightness = 1.0;  // share of the colours' that is shown
};

/// The day's colours, its hours and the sun's way; the share of the day that is clicked on. With no
/// strip yet its place is kept free.
[[nodiscard]] std::optional<double> DayStripControl(const DayStrip* strip, double day_fraction,
                                                    const StripLook& look);

/// A field for a part of a name and the list of places that have it, by name and best first
/// (PlacesByName, places.h), into the window of Dear ImGui that is begun.
/// @return  the name of the place that was clicked on, or of the first one when Enter was pressed.
[[nodiscard]] std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px);

}  // namespace alpenglow::viewer
