// SPDX-License-Identifier: MIT
// Position and orientation of an eye or a camera. Angles:
// heading clockwise from north, pitch upwards, roll clockwise seen from behind, and the horizontal
// field of view.
#pragma once

#include "atmosphere/math/view_axes.h"
#include "atmosphere/time_place/geodesy.h"

namespace alpenglow::atmosphere {

struct CameraPose {
  Place place;  // above the ellipsoid
  double heading_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  double fov_rad = 1.0471975511965976;

  bool operator==(const CameraPose&) const = default;
};

/// Returns the unit axes of the view, in the frame east, north, up at the eye.
[[nodiscard]] inline ViewAxes AxesOf(const CameraPose& pose) {
  return AxesFromAngles(pose.heading_rad, pose.pitch_rad, pose.roll_rad);
}

}  // namespace alpenglow::atmosphere
