// SPDX-License-Identifier: MIT
#include "viewer/flight/flight.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

/// Returns the turn rate. It is proportional to the field of view, so that a telescopic view turns
/// slowly, up to 45 degrees a second at 60 degrees.
double TurnRate(const CameraPose& eye) {
  return 0.75 * std::min(eye.fov_rad, 60.0 * kRadiansPerDegree);
}

}  // namespace

const char* NameOf(FlightMode mode) {
  constexpr EnumNames kNames{{std::pair{FlightMode::kFree, "free camera"},
                              {FlightMode::kAircraft, "aircraft"},
                              {FlightMode::kTrack, "track"}}};
  return kNames.Of(mode);
}

CameraPose Placed(const CameraPose& eye, const EyePlacement& placement) {
  CameraPose placed = eye;
  if (placement.latitude_deg || placement.longitude_deg || placement.height_m) {
    placed.place = CheckedPlace(
        {placement.latitude_deg.value_or(eye.place.latitude_deg),
         placement.longitude_deg.value_or(eye.place.longitude_deg),
         placement.height_m ? RequireInRange(*placement.height_m, -12000.0, 1e9, "--altitude")
                            : eye.place.height_m});
  }
  if (placement.heading_deg) {
    placed.heading_rad =
        RequireInRange(*placement.heading_deg, -360.0, 360.0, "--heading") * kRadiansPerDegree;
  }
  if (placement.pitch_deg) {
    placed.pitch_rad =
        RequireInRange(*placement.pitch_deg, -90.0, 90.0, "--pitch") * kRadiansPerDegree;
  }
  return placed;
}

double SpeedAt(double above_ground_m) {
  constexpr double kSlowest_m_per_s = 2.0;
  constexpr double kHeightsPerSecond = 0.3;
  constexpr double kFastest_m_per_s = 200e3;
  return std::clamp(kSlowest_m_per_s + kHeightsPerSecond * above_ground_m, kSlowest_m_per_s,
                    kFastest_m_per_s);
}

CameraPose Steer(const CameraPose& eye, const Steering& steering, const Ellipsoid& ellipsoid,
                 double above_ground_m, double seconds) {
  const double turn_rad = TurnRate(eye) * seconds;
  CameraPose moved = Turned(eye, steering.turn_right * turn_rad, steering.pitch_up * turn_rad);
  moved.roll_rad = std::remainder(eye.roll_rad + steering.roll_right * turn_rad, 2.0 * kPi);
  const ViewAxes axes = AxesOf(moved);
  const double step_m = SpeedAt(above_ground_m) * seconds;
  const glm::dvec3 step = step_m * (steering.forward * axes.forward + steering.right * axes.right +
                                    glm::dvec3(0.0, 0.0, steering.up));
  if (glm::length(step) == 0.0) return moved;
  const LocalFrame here(ellipsoid, moved.place);
  const Place there = here.GeodeticFromEnu(Point<Enu>{step});
  // North changes direction along the path; the direction of flight does not.
  const Vector<Ecef> ahead = here.EcefFromEnu(
      Vector<Enu>{{std::sin(moved.heading_rad), std::cos(moved.heading_rad), 0.0}});
  moved.place = there;
  const Vector<Enu> ahead_there = LocalFrame(ellipsoid, there).EnuFromEcef(ahead);
  moved.heading_rad = std::atan2(ahead_there.xyz.x, ahead_there.xyz.y);
  return moved;
}

CameraPose FreeFlight(const CameraPose& eye, const Steering& steering, const Ellipsoid& ellipsoid,
                      const GroundHeight& ground, double speed_factor, double seconds) {
  constexpr double kLongest_s = 1.0 / 60.0;
  const auto steps =
      std::max(static_cast<std::int64_t>(std::ceil(seconds / kLongest_s)), std::int64_t{1});
  const double step_s = seconds / static_cast<double>(steps);
  Steering scaled = steering;
  for (double* pace : {&scaled.forward, &scaled.right, &scaled.up}) *pace *= speed_factor;
  CameraPose moved = eye;
  for (std::int64_t i = 0; i < steps; ++i) {
    const double ground_m = ground(moved.place);
    const double clearance_m = ClearanceOf(moved, ground_m);
    moved = Steer(moved, scaled, ellipsoid, std::max(moved.place.height_m - ground_m, 0.0), step_s);
    moved = KeptAbove(moved, ground(moved.place), clearance_m);
  }
  return moved;
}

CameraPose EyeAt(const NamedPlace& there, const CameraPose& before, const GroundHeight& ground) {
  const double above_m = there.kind == PlaceKind::kAirport ? 2.0
                         : there.kind == PlaceKind::kPeak  ? 100.0
                                                           : 600.0;
  CameraPose eye = before;
  eye.place = there.place;
  eye.place.height_m = ground(there.place) + above_m;
  eye.pitch_rad = eye.roll_rad = 0.0;
  if (there.kind == PlaceKind::kAirport) {
    eye.heading_rad = std::remainder(there.heading_rad, 2.0 * kPi);
  }
  return eye;
}

CameraPose Turned(const CameraPose& eye, double right_rad, double up_rad) {
  // In a rolled view, a turn to the right changes both heading and pitch.
  const double c = std::cos(eye.roll_rad), s = std::sin(eye.roll_rad);
  CameraPose turned = eye;
  turned.heading_rad = std::remainder(eye.heading_rad + c * right_rad + s * up_rad, 2.0 * kPi);
  turned.pitch_rad = std::clamp(eye.pitch_rad + c * up_rad - s * right_rad, -0.5 * kPi, 0.5 * kPi);
  return turned;
}

CameraPose Zoomed(const CameraPose& eye, double factor) {
  CameraPose zoomed = eye;
  zoomed.fov_rad = std::clamp(eye.fov_rad * factor, kNarrowestView_rad, kWidestView_rad);
  return zoomed;
}

double ClearanceOf(const CameraPose& eye, double ground_m) {
  const double above_m = eye.place.height_m - ground_m;
  return above_m < 0.0 ? kStandingEye_m : std::clamp(above_m, kLowestEye_m, kStandingEye_m);
}

CameraPose KeptAbove(const CameraPose& eye, double ground_m, double clearance_m) {
  CameraPose kept = eye;
  kept.place.height_m = std::max(eye.place.height_m, ground_m + clearance_m);
  return kept;
}

}  // namespace alpenglow::viewer
