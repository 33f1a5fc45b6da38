// SPDX-License-Identifier: MIT
// Frames of a series along a camera's path.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/camera/camera_path.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/picture/render.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// How many frames, as typed: `every` (a duration of the path) or `count` (the path's ends
/// included), else so many a second.
struct PathRate {
  std::optional<std::string> every;
  std::optional<int> count;
  double per_second = 25.0;
};

/// Seconds of the path between two frames. Throws InputError for an `every` that is not positive, a
/// `count` below 1 and a rate that is not positive.
[[nodiscard]] double FrameInterval(const CameraPath& path, const PathRate& rate);

/// Frames from the first point of the path on. Their instants are the
/// path's; where it has none, `start` is that of the first point.
/// Throws InputError as FrameInterval and for more than kMostFrames.
[[nodiscard]] std::vector<Frame> FramesAlong(const CameraPath& path, const PathRate& rate,
                                             const UtcInstant& start);

/// The camera of a frame; with a shutter that is open for a time around it, its way in that time.
[[nodiscard]] Shot ShotOf(const Frame& frame, const CameraPath& path, double shutter_s);

}  // namespace alpenglow::renderer
