// SPDX-License-Identifier: MIT
// The colours of the sky through one day: what a pilot clicks on to choose the time.
//
// Columns are instants, rows elevations over the horizon under the sun, the zenith above. Light
// by AirIntegrator and DiffuseLight, without a moon. Each column is exposed between what a meter
// would pick for it and a bright day, so that night is dark and yet dusk shows its colours:
//
//   EV = 0.8 EV(meter, mean luminance of the column) + 0.2 EV 14
#pragma once

#include <array>
#include <memory>
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

}  // namespace alpenglow::viewer
