// SPDX-License-Identifier: MIT
// This header turns a track into the path of a camera that looks along it.
//
//   bank = atan(v psi' / g), to 35 degrees           psi' is the turn of the path per second
//
// The camera passes through all points of the track on the smooth curve of CameraPath; between
// segments of the track it moves in a straight line at constant speed. Recorded positions are
// noisier than real flight, so the motion is smoothed. The camera looks along a chord of the curve
// that spans 4 s. Its position along the curve, and hence its speed, follows the least-squares
// parabola over 4 s before and after, except near steps of the track of more than 4 s (pauses, and
// receivers that record seldom). The bank is smoothed over 4 s too.
#pragma once

#include "renderer/camera/camera_path.h"
#include "renderer/camera/track_file.h"

namespace alpenglow::renderer {

struct TrackStyle {
  double speed_m_per_s = 60.0;   // for a track without times
  double over_ground_m = 100.0;  // for a track without heights
  double fov_rad = 1.0471975511965976;
};

/// Returns the camera path of a track, with one point per second, but at least 200 and at most
/// 20000 points. Instants are those of the track if all of its points have one and they increase;
/// otherwise the track is flown at constant speed. Points less than 0.5 m from the previous point,
/// or not later than it, are skipped. Throws InputError if fewer than two points remain or the
/// style's numbers are not positive.
[[nodiscard]] CameraPath PathAlong(const Track& track, const TrackStyle& style,
                                   const GroundHeight& ground);

}  // namespace alpenglow::renderer
