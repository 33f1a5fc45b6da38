// SPDX-License-Identifier: MIT
// A track as the path of a camera that looks along it.
//
//   bank = atan(v psi' / g), to 35 degrees           psi' is the turn of the path per second
//
// The camera goes through all points of the track on the smooth curve of CameraPath; between segments
// of the track it goes straight and with even speed. Receivers are not as steady as wings: it looks
// where the chord of the curve points, over 4 s; where it is on the curve, and so its speed, is the
// parabola that fits best 4 s before and after, except near steps of the track of more than 4 s
// (pauses, and receivers that write seldom); the bank is smoothed over 4 s too.
#pragma once

#include "renderer/camera/camera_path.h"
#include "renderer/camera/track_file.h"

namespace alpenglow::renderer {

struct TrackStyle {
  double speed_m_per_s = 60.0;   // of a track without times
  double over_ground_m = 100.0;  // of a track without heights
  double fov_rad = 1.0471975511965976;
};

/// Its points are one every second at most, 200 at least and 20000 at most. Instants are those of
/// the track, when all of its points have one and later points later ones; else it is flown with an
/// even speed. Points that are less than 0.5 m or no time after the one before them are passed
/// over. Throws InputError when fewer than two are left, or the style's numbers are not positive.
[[nodiscard]] CameraPath PathAlong(const Track& track, const TrackStyle& style,
                                   const GroundHeight& ground);

}  // namespace alpenglow::renderer
