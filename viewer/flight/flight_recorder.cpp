// SPDX-License-Identifier: MIT
#include "viewer/flight/flight_recorder.h"

#include <fmt/format.h>

#include "atmosphere/text/error.h"
#include "lut/program/atomic_file.h"
#include "renderer/series/frame_name.h"

namespace alpenglow {

CameraPose PoseOf(const Eye& eye) {
  return {eye.place, eye.heading_rad, eye.pitch_rad, eye.roll_rad, eye.fov_rad};
}

Eye EyeOf(const CameraPose& pose) {
  return {pose.place, pose.heading_rad, pose.pitch_rad, pose.roll_rad, pose.fov_rad};
}

void FlightRecorder::Note(double elapsed_s, const Eye& eye, const UtcInstant& now) {
  // Frames of a sixtieth of a second come in threes, so that half of one is no reason to wait.
  constexpr double kEarly_s = 0.005;
  if (!points_.empty() && elapsed_s < points_.back().time_s + kInterval_s - kEarly_s) return;
  points_.push_back({elapsed_s, PoseOf(eye), now});
}

void FlightRecorder::Write(const std::filesystem::path& file) const {
  if (!points_.empty()) WriteTextAtomically(file, TextOf(CameraPath(points_)));
}

ReplayFrame ReplayAt(const CameraPath& path, double path_s) {
  return {path_s, EyeOf(path.PoseAt(path_s)), path.UtcAt(path_s)};
}

std::vector<std::filesystem::path> ReplayPictures(const std::string& pattern, int count) {
  if (count == 1) return {pattern};
  const std::filesystem::path last = pattern;
  const bool is_png = last.extension() == ".png";
  const FrameName name(is_png ? std::filesystem::path(last).replace_extension(".exr").string()
                              : pattern);
  if (!name.HasNumber()) {
    throw InputError(fmt::format(
        "--screenshot has no frame number (%04d), but the replay has {} pictures", count));
  }
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < count; ++i) files.push_back(is_png ? name.Png(i) : name.Exr(i));
  return files;
}

}  // namespace alpenglow
