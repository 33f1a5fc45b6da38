// SPDX-License-Identifier: MIT
// Where air shows land and the edge of a bare planet, in closed form: for shaders, which work it out
// vertex by vertex (land_lift.glsl), and what they read.
//
// A planet that bends rays looks as one of another radius with straight rays does: the one whose
// horizon is where the bent rays that graze the ground have it,
//
//   R' / (R' + h) = cos(dip).
#pragma once

#include "atmosphere/sun/bent_ray.h"

namespace alpenglow::atmosphere {

/// Bending of rays by the air as an eye at one height sees it; kilometres.
struct LandBend {
  double radius_km, look_radius_km;    // of the planet, and of the one that it looks as
  double top_km;                       // rays are straight above
  double usual_per_km;                 // curvature of most rays from this eye
  std::array<double, 3> slope_per_km;  // curvature of level rays at the ground, layer by layer
  std::array<double, 3> fall_per_km;   // with height

  /// Curvature of level rays at the ground.
  [[nodiscard]] double MostCurvature() const {
    return slope_per_km[0] + slope_per_km[1] + slope_per_km[2];
  }
};

/// @param air  that bends gently. @param height_m  of the eye; below 0 as 0.
[[nodiscard]] LandBend LandBendOf(const BendingAir& air, double height_m);

/// By how much a place up to 9 km high is lifted [rad] that is not behind the ground, before the horizon
/// or behind it: within 0.3' of the ray equation for eyes up to 16 km, within 0.5' for higher ones.
/// @param distance_m  straight from the eye.
[[nodiscard]] double LiftOfLand(const LandBend& bend, double eye_m, double place_m,
                                double distance_m);

/// Returns the largest lift [rad] of anything that an eye sees of a planet: of its horizon, or of land at its radius
/// as far away as the farthest.
[[nodiscard]] double MostLiftOfPlanet(const LandBend& bend, double eye_m, double farthest_land_m);

}  // namespace alpenglow::atmosphere
