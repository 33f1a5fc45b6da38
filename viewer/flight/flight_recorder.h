// SPDX-License-Identifier: MIT
// Flights written down as camera paths, and flown again.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "atmosphere/sun/time.h"
#include "renderer/camera/camera_path.h"
#include "viewer/flight/flight.h"

namespace alpenglow {

[[nodiscard]] CameraPose PoseOf(const Eye& eye);
[[nodiscard]] Eye EyeOf(const CameraPose& pose);

/// Takes down where the eye is, 25 times a second at most.
class FlightRecorder {
 public:
  static constexpr double kInterval_s = 0.04;

  /// @param elapsed_s  since the flight began; passed over when the last point is too near.
  void Note(double elapsed_s, const Eye& eye, const UtcInstant& now);

  /// Throws OutputError when the file cannot be written. Nothing is written before the first Note.
  void Write(const std::filesystem::path& file) const;

 private:
  std::vector<CameraPathPoint> points_;
};

/// What a frame of a replay shows.
struct ReplayFrame {
  double path_s;
  Eye eye;
  std::optional<UtcInstant> now;  // nothing: as the viewer's clock goes on
};
[[nodiscard]] ReplayFrame ReplayAt(const CameraPath& path, double path_s);

/// Names of the pictures of a replay: "out.%04d.png" by number, one name for one picture. Throws
/// InputError for several pictures under one name.
[[nodiscard]] std::vector<std::filesystem::path> ReplayPictures(const std::string& pattern,
                                                                int count);

}  // namespace alpenglow
