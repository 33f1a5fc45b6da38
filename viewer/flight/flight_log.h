// SPDX-License-Identifier: MIT
// All that has been flown so far, to be flown again or written down.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "renderer/camera/camera_path.h"
#include "viewer/flight/flight_recorder.h"

namespace alpenglow::viewer {

/// A flight in memory that does not grow without end: points as often as FlightRecorder has them,
/// and every second one of them, from then on half as often, each time that there would be too
/// many. Of a day there is one every 2.6 s.
class FlightLog {
 public:
  static constexpr std::size_t kMostPoints = std::size_t{1} << 16;  // 7 MB, 43 minutes of all
  explicit FlightLog(std::size_t most_points = kMostPoints) : most_(most_points) {}

  /// @param elapsed_s  of flying; grows.
  void Note(double elapsed_s, const Eye& eye, const UtcInstant& now);

  /// From the first Note to the last one, from 0 s on. Throws InputError when nothing has been
  /// flown.
  [[nodiscard]] CameraPath Path() const;

 private:
  std::size_t most_;
  double interval_s_ = FlightRecorder::kInterval_s;
  std::vector<CameraPathPoint> points_;
  std::optional<CameraPathPoint> last_;  // of points_ or after them
  bool has_flown_ = false;               // the eye has been anywhere but where it began
};

}  // namespace alpenglow::viewer
