// SPDX-License-Identifier: MIT
// Provides the eye of an interactive flight: its position, its direction, and its motion under keys
// and mouse.
#pragma once

#include <optional>

#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/camera_pose.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/camera/camera_path.h"
#include "renderer/scene/places.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Control of the eye: a free camera, an aircraft, or a track that is followed.
enum class FlightMode { kFree, kAircraft, kTrack };
/// Returns "free camera", "aircraft" or "track".
[[nodiscard]] const char* NameOf(FlightMode mode);

/// Position and direction for an eye, as typed by the user; unset values remain unchanged.
struct EyePlacement {
  std::optional<double> latitude_deg = {};
  std::optional<double> longitude_deg = {};
  std::optional<double> height_m = {};
  std::optional<double> heading_deg = {};
  std::optional<double> pitch_deg = {};
};
/// Returns the eye moved by a placement. Throws InputError that names the option of a value out of
/// range.
[[nodiscard]] CameraPose Placed(const CameraPose& eye, const EyePlacement& placement);

/// Inputs for the free camera, each in [-1, 1].
struct Steering {
  double forward = 0.0;
  double right = 0.0;
  double up = 0.0;
  double turn_right = 0.0;
  double pitch_up = 0.0;
  double roll_right = 0.0;
};

/// Returns the speed of the free camera [m/s] at a height over the ground: walking pace at the
/// ground, the height of a mountain in seconds above it, kilometres per second in orbit.
[[nodiscard]] double SpeedAt(double above_ground_m);

/// Returns the eye after `seconds` of steering at SpeedAt(above_ground_m). Forward motion is along
/// the view; the path follows the ellipsoid. Pitch is limited to the vertical.
[[nodiscard]] CameraPose Steer(const CameraPose& eye, const Steering& steering,
                               const Ellipsoid& ellipsoid, double above_ground_m, double seconds);

/// Returns the eye after `seconds` of steering at `speed_factor` times SpeedAt its height over the
/// ground, in steps of at most 1/60 s. One long frame therefore ends where several short ones do,
/// within 1 % of the distance. The eye keeps its ClearanceOf while it moves.
[[nodiscard]] CameraPose FreeFlight(const CameraPose& eye, const Steering& steering,
                                    const Ellipsoid& ellipsoid, const GroundHeight& ground,
                                    double speed_factor, double seconds);

/// Returns an eye at a place: at the middle of the runway, 2 m above the ground and looking along
/// it; 100 m above a peak; 600 m above a city or a pole. The published height is not used.
[[nodiscard]] CameraPose EyeAt(const NamedPlace& there, const CameraPose& before,
                               const GroundHeight& ground);

/// Returns the eye turned to the right and upwards [rad] in its own frame, which may be rolled.
[[nodiscard]] CameraPose Turned(const CameraPose& eye, double right_rad, double up_rad);

/// Limits of the field of view in windows and under instruments. Written pictures have any field of
/// view of a scene.
inline constexpr double kNarrowestView_rad = 1.0 * kRadiansPerDegree;
inline constexpr double kWidestView_rad = 120.0 * kRadiansPerDegree;

/// Returns the eye with its field of view multiplied by `factor` and clamped to these limits.
[[nodiscard]] CameraPose Zoomed(const CameraPose& eye, double factor);
/// Returns the eye with the field of view that a window shows.
[[nodiscard]] inline CameraPose InWindow(const CameraPose& eye) { return Zoomed(eye, 1.0); }

/// Height [m] above the ground of an eye that stands on it, and the minimum of every eye. With a
/// smaller minimum, rounding errors could show the land from below.
inline constexpr double kStandingEye_m = 1.5, kLowestEye_m = 0.1;

/// Returns the least height [m] above the ground that a free camera may come to. One that a scene
/// puts lower than a standing eye stays there; one under the ground is raised to a standing eye.
[[nodiscard]] double ClearanceOf(const CameraPose& eye, double ground_m);

/// Returns the eye raised to at least `clearance_m` above ground of height `ground_m`.
[[nodiscard]] CameraPose KeptAbove(const CameraPose& eye, double ground_m, double clearance_m);

}  // namespace alpenglow::viewer
