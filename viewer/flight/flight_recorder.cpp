// SPDX-License-Identifier: MIT
#include "viewer/flight/flight_recorder.h"

#include <fmt/format.h>

#include "atmosphere/base/async_value.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/growing_file.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/image/picture_format.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::viewer {

bool IsDue(double elapsed_s, double last_s, double interval_s) {
  // Tolerance for frame times: a point may be recorded slightly early instead of one frame late. At
  // 60 frames a second every third frame is recorded.
  constexpr double kEarly_s = 0.005;
  return elapsed_s >= last_s + interval_s - kEarly_s;
}

struct FlightRecorder::State {
  std::filesystem::path name;
  GrowingFile file;
  std::optional<double> begin_s, last_s;  // times of the first and the last point
  double synced_s = 0.0;
  std::optional<std::string> fault;
  // Sync runs in another thread, because a disk may take longer than a frame. The lines are already
  // in the system's buffers.
  AsyncValue<int, int> sync{[this](const int& request) {
    file.Sync();
    return request;
  }};

  explicit State(const std::filesystem::path& of) : name(of), file(of) {
    if (!file.kept()) return;
    Log(fmt::format("skyview: {} is a flight that was cut short; it is {} now\n",
                    file.part().string(), file.kept()->string()));
  }

  void Append(const CameraPathPoint& point) {
    constexpr double kUnsynced_s = 2.0;
    if (!last_s) file.Append(HeaderOfCameraPath(point.utc.has_value()));
    file.Append(LineOf(point));
    if (point.time_s < synced_s + kUnsynced_s) return;
    sync.Request(0);
    synced_s = point.time_s;
  }
};

FlightRecorder::FlightRecorder() = default;

FlightRecorder::FlightRecorder(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {}

FlightRecorder::~FlightRecorder() {
  try {
    Finish();
  } catch (const std::exception& error) {
    Log(fmt::format("skyview: {}\n", error.what()));
  }
}

void FlightRecorder::Begin(const std::filesystem::path& file) {
  Finish();
  state_ = std::make_unique<State>(file);
}

std::optional<std::filesystem::path> FlightRecorder::file() const {
  return state_ && !state_->fault ? std::optional(state_->name) : std::nullopt;
}

void FlightRecorder::Record(double elapsed_s, const CameraPose& eye, const UtcTime& now) {
  if (!state_ || state_->fault) return;
  if (state_->last_s && !IsDue(elapsed_s, *state_->last_s, kInterval_s)) return;
  if (!state_->begin_s) state_->begin_s = elapsed_s;
  try {
    state_->Append({elapsed_s - *state_->begin_s, eye, now});
    state_->last_s = elapsed_s;
  } catch (const OutputError& error) {
    state_->fault = error.what();
    Log(fmt::format("skyview: {}; the flight is recorded no further\n", error.what()));
  }
}

bool FlightRecorder::Finish() {
  const std::unique_ptr<State> state = std::move(state_);
  if (!state) return false;
  state->sync.Wait();
  if (state->fault) throw OutputError(*state->fault);
  state->file.Finish();
  if (!state->last_s)
    Log(fmt::format("skyview: {} is not written: nothing was flown\n", state->name.string()));
  return state->last_s.has_value();
}

CameraPath ReadFlight(const std::filesystem::path& file) {
  const std::filesystem::path part = GrowingFile::PartOf(file);
  if (!std::filesystem::exists(file) && std::filesystem::exists(part)) {
    throw InputError(fmt::format("{}: is not there; {} is, of a flight that was cut short",
                                 file.string(), part.string()));
  }
  CameraPath path = ReadCameraPath(file);
  if (HasExtension(file, part.extension().string())) {
    Log(fmt::format("skyview: {} is unfinished: a flight that was cut short after {:.1f} s\n",
                    file.string(), path.end_s()));
  }
  return path;
}

ReplayFrame ReplayAt(const CameraPath& path, double path_s) {
  return {path_s, path.PoseAt(path_s), path.UtcAt(path_s)};
}

std::vector<std::filesystem::path> ReplayPictures(const std::string& pattern, int count) {
  if (count == 1) return {pattern};
  const FrameName name(pattern, FormatOfPicture(pattern).extension);
  if (!name.HasNumber()) {
    throw InputError(fmt::format(
        "--screenshot has no frame number (%04d), but the replay has {} pictures", count));
  }
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < count; ++i) files.push_back(name.Picture(i));
  return files;
}

namespace {

std::vector<CameraPathPoint> EverySecond(const std::vector<CameraPathPoint>& points) {
  std::vector<CameraPathPoint> kept;
  for (std::size_t i = 0; i < points.size(); i += 2) kept.push_back(points[i]);
  return kept;
}

}  // namespace

void FlightLog::Record(double elapsed_s, const CameraPose& eye, const UtcTime& now) {
  last_ = CameraPathPoint{elapsed_s, eye, now};
  has_flown_ = has_flown_ || (!points_.empty() && points_.front().pose != eye);
  if (!points_.empty() && !IsDue(elapsed_s, points_.back().time_s, interval_s_)) return;
  points_.push_back(*last_);
  if (points_.size() < most_) return;
  points_ = EverySecond(points_);
  interval_s_ *= 2.0;
}

CameraPath FlightLog::Path() const {
  if (!has_flown_) throw InputError("nothing has been flown yet");
  std::vector<CameraPathPoint> points = points_;
  if (last_->time_s > points.back().time_s) points.push_back(*last_);
  const double begin_s = points.front().time_s;
  for (CameraPathPoint& point : points) point.time_s -= begin_s;
  return CameraPath(std::move(points));
}

}  // namespace alpenglow::viewer
