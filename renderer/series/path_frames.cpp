// SPDX-License-Identifier: MIT
#include "renderer/series/path_frames.h"

#include <fmt/format.h>

#include <cmath>

#include "atmosphere/text/error.h"
#include "renderer/ground/camera_stand.h"

namespace alpenglow::renderer {
namespace {

double Positive(double value, const std::string& name) {
  if (!(value > 0.0 && std::isfinite(value))) {
    throw InputError(fmt::format("{} is {}; it must be positive", name, value));
  }
  return value;
}

}  // namespace

double FrameInterval(const CameraPath& path, const PathRate& rate) {
  if (rate.every) return Positive(ParseDuration(*rate.every), "--every");
  if (!rate.count) return 1.0 / Positive(rate.per_second, "--fps");
  RequireInRange(*rate.count, 1, kMostFrames, "--count");
  return (path.end_s() - path.begin_s()) / std::max(*rate.count - 1, 1);
}

std::vector<Frame> FramesAlong(const CameraPath& path, const PathRate& rate,
                               const UtcInstant& start) {
  const double interval_s = FrameInterval(path, rate);
  const double length_s = path.end_s() - path.begin_s();
  // A last frame that rounding puts after the path's end is one of the path.
  constexpr double kRounding = 1e-9;
  const double count =
      rate.count ? *rate.count : std::floor(length_s / interval_s * (1.0 + kRounding)) + 1.0;
  if (!(count <= kMostFrames)) {
    throw InputError(fmt::format("the path has {:.0f} frames; at most {}", count, kMostFrames));
  }
  std::vector<Frame> frames;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double along_s = i * interval_s;
    const double path_s = path.begin_s() + along_s;
    frames.push_back({i, path.UtcAt(path_s).value_or(AddSeconds(start, along_s)), path_s});
  }
  return frames;
}

Shot ShotOf(const Frame& frame, const CameraPath& path, double shutter_s) {
  // Straight ways between 16 steps miss a curve by less than a hundredth of its length.
  constexpr int kSteps = 17;
  Shot shot(frame.instant);
  shot.poses = path.PosesBetween(frame.path_s - 0.5 * shutter_s, frame.path_s + 0.5 * shutter_s,
                                 shutter_s > 0.0 ? kSteps : 1);
  return shot;
}

}  // namespace alpenglow::renderer
