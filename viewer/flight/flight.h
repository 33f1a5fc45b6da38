// SPDX-License-Identifier: MIT
// An eye that flies: where it is, where it looks, how keys and mouse move it.
#pragma once

#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/camera/camera_path.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Who moves the eye: the pilot freely, wings and engine, or a track that is followed.
enum class FlightMode { kFree, kAircraft, kTrack };

/// The eye. Angles in radians.
struct Eye {
  GeodeticPosition place;               // height over the ellipsoid
  double heading_rad = 0.0;             // clockwise from north
  double pitch_rad = 0.0;               // up is positive
  double roll_rad = 0.0;                // clockwise seen from behind
  double fov_rad = 1.0471975511965976;  // horizontal

  bool operator==(const Eye&) const = default;
};

/// Where an eye is put, as people type it; what is left out stays as it is.
struct EyePlacement {
  std::optional<double> latitude_deg = {};
  std::optional<double> longitude_deg = {};
  std::optional<double> height_m = {};
  std::optional<double> heading_deg = {};
  std::optional<double> pitch_deg = {};
};
/// The eye put there. Throws InputError naming the option for values out of range.
[[nodiscard]] Eye Placed(const Eye& eye, const EyePlacement& placement);

/// What the pilot asks for, each in [-1, 1].
struct Steering {
  double forward = 0.0;
  double right = 0.0;
  double up = 0.0;
  double turn_right = 0.0;
  double pitch_up = 0.0;
  double roll_right = 0.0;
};

/// Unit vectors of the view in the frame (east, north, up) at the eye.
struct ViewAxes {
  glm::dvec3 right, up, forward;
};
[[nodiscard]] ViewAxes AxesOf(const Eye& eye);

/// Speed of a free flight [m/s] at a height over the ground: walking pace on the ground, a
/// mountain's height in seconds above it, kilometres a second in orbit.
[[nodiscard]] double SpeedAt(double above_ground_m);

/// The eye after `seconds` of steering at SpeedAt(above_ground_m). Forward is along the view; the
/// path follows the ellipsoid. Pitch stops at the vertical.
[[nodiscard]] Eye Steer(const Eye& eye, const Steering& steering, const Ellipsoid& ellipsoid,
                        double above_ground_m, double seconds);

/// The eye after `seconds` of steering at `speed_factor` times SpeedAt its height over the ground,
/// in steps of a 60th of a second at most: a long frame ends where short ones do, within 1 % of the
/// way. It never comes nearer to the ground than 1.5 m.
[[nodiscard]] Eye FreeFlight(const Eye& eye, const Steering& steering, const Ellipsoid& ellipsoid,
                             const GroundHeight& ground, double speed_factor, double seconds);

/// The eye turned [rad] to the right and up as it sees them, rolled or not.
[[nodiscard]] Eye Turned(const Eye& eye, double right_rad, double up_rad);

/// The eye with its field of view times `factor`, kept in [1, 120] degrees.
[[nodiscard]] Eye Zoomed(const Eye& eye, double factor);

/// The eye lifted to at least `clearance_m` over ground of height `ground_m`.
[[nodiscard]] Eye KeptAbove(const Eye& eye, double ground_m, double clearance_m);

}  // namespace alpenglow::viewer
