// SPDX-License-Identifier: MIT
// Flights written down as camera paths, and flown again.
//
// All that has been flown so far, to be flown again or written down.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/time.h"
#include "renderer/camera/camera_path.h"
#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

[[nodiscard]] CameraPose PoseOf(const Eye& eye);
[[nodiscard]] Eye EyeOf(const CameraPose& pose);

/// Whether so much has passed since the point noted last that another one is to be noted.
[[nodiscard]] bool IsDue(double elapsed_s, double last_s, double interval_s);

/// Takes down where the eye is, 25 times a second at most, as it flies: FILE.part has every line
/// before the next frame is drawn and becomes FILE when the flight ends, however it ends. After a
/// SIGKILL FILE.part stays with all that was flown, after a loss of power with all but the last two
/// seconds. Takes as much memory for a day as for a minute.
class FlightRecorder {
 public:
  static constexpr double kInterval_s = 0.04;

  /// Takes nothing down until it begins.
  FlightRecorder();
  /// Begins FILE.part; says so when it finds one, of a flight that was cut short, and keeps that
  /// under another name. Throws OutputError, also when another process records into the file.
  explicit FlightRecorder(const std::filesystem::path& file);
  /// Finishes what is not finished; says what fails.
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// Begins another file, as the constructor does; finishes the one before.
  void Begin(const std::filesystem::path& file);

  /// @param elapsed_s  since any moment; the file counts from the first point. Passed over when the
  /// last point is too near. Of a file that takes no more is told once, and the flight goes on
  /// without it.
  void Note(double elapsed_s, const Eye& eye, const UtcInstant& now);

  /// What is being recorded into; nothing: nothing is.
  [[nodiscard]] std::optional<std::filesystem::path> file() const;

  /// Gives the file its name; before the first Note there is none, which is said. Returns whether
  /// there is a file. Throws OutputError, also for lines that the file has not taken.
  bool Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;  // none: takes nothing down
};

/// A recorded flight, or any camera path. A FILE.part is one that was cut short, and so is said.
/// Throws InputError as ReadCameraPath; names FILE.part where that is there and FILE is not.
[[nodiscard]] CameraPath ReadFlight(const std::filesystem::path& file);

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
