// SPDX-License-Identifier: MIT
// Provides FlightRecorder, which writes a flight to a file as a camera path, functions to replay
// such a file, and FlightLog, which keeps the current flight in memory to replay or save it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/time.h"
#include "renderer/camera/camera_path.h"
#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

/// Returns whether the next point is due, given the time of the last recorded point.
[[nodiscard]] bool IsDue(double elapsed_s, double last_s, double interval_s);

/// Records the eye of a flight at most 25 times a second. Each line is in FILE.part before the next
/// frame is drawn, and FILE.part becomes FILE when the flight ends, however it ends. After a
/// SIGKILL, FILE.part contains the whole flight; after a loss of power, all but the last two
/// seconds. The memory use does not grow with the length of a flight.
class FlightRecorder {
 public:
  static constexpr double kInterval_s = 0.04;

  /// Records nothing until Begin is called.
  FlightRecorder();
  /// Begins FILE.part. An existing FILE.part of an interrupted flight is kept under another name,
  /// and a message names it. Throws OutputError, also if another process records into the file.
  explicit FlightRecorder(const std::filesystem::path& file);
  /// Finishes the current file and reports errors as messages.
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// Begins another file as the constructor does, and finishes the current one.
  void Begin(const std::filesystem::path& file);

  /// Records a point. The point is skipped if the last one is too recent. If the file cannot be
  /// written, one message reports it and the flight continues without recording.
  /// @param elapsed_s  since any fixed instant; times in the file start at the first point.
  void Record(double elapsed_s, const CameraPose& eye, const UtcTime& now);

  /// Returns the file that is being recorded; nullopt if there is none.
  [[nodiscard]] std::optional<std::filesystem::path> file() const;

  /// Renames FILE.part to FILE. If nothing was recorded there is no file, and a message reports
  /// this. Returns whether the file exists. Throws OutputError, also for lines that could not be
  /// written.
  bool Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;  // null: nothing is recorded
};

/// Reads a recorded flight or any camera path. A message reports that a FILE.part belongs to an
/// interrupted flight. Throws InputError as ReadCameraPath does; its text names FILE.part if that
/// exists and FILE does not.
[[nodiscard]] CameraPath ReadFlight(const std::filesystem::path& file);

/// Content of one frame of a replay.
struct ReplayFrame {
  double path_s;
  CameraPose eye;
  std::optional<UtcTime> now;  // nullopt: the clock of the viewer continues
};
[[nodiscard]] ReplayFrame ReplayAt(const CameraPath& path, double path_s);

/// Returns the names of the pictures of a replay: numbered for a pattern "out.%04d.png", or one
/// name for one picture. Throws InputError for several pictures under one name.
[[nodiscard]] std::vector<std::filesystem::path> ReplayPictures(const std::string& pattern,
                                                                int count);

/// A flight in memory of limited size. It begins with the points of FlightRecorder. Each time the
/// limit is reached it drops every second point and doubles the interval. After a day the interval
/// is 2.6 s.
class FlightLog {
 public:
  static constexpr std::size_t kMostPoints = std::size_t{1} << 16;  // 7 MB, 43 min at full rate
  explicit FlightLog(std::size_t most_points = kMostPoints) : most_(most_points) {}

  /// @param elapsed_s  time of flight; it increases.
  void Record(double elapsed_s, const CameraPose& eye, const UtcTime& now);

  /// Returns the path from the first to the last Note; it starts at 0 s. Throws InputError if the
  /// eye has not moved.
  [[nodiscard]] CameraPath Path() const;

 private:
  std::size_t most_;
  double interval_s_ = FlightRecorder::kInterval_s;
  std::vector<CameraPathPoint> points_;
  std::optional<CameraPathPoint> last_;  // the last of points_ or a later one
  bool has_flown_ = false;               // the eye has left its first position
};

}  // namespace alpenglow::viewer
