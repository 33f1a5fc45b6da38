// SPDX-License-Identifier: MIT
#include "atmosphere/ray/land_lift.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/ray/shell.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "atmosphere/ray/land_lift.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::atmosphere {

namespace {

double LookRadius_m(const BendingAir& air, double height_m) {
  const double height = std::max(height_m, 1.0);  // it hardly changes below
  const double dip = GrazingElevation(air, height);
  const double sine = std::sin(0.5 * dip);
  return height * std::cos(dip) / (2.0 * sine * sine);
}

// Share of the curvature at the ground that most rays to far land have, fitted to the ray equation
// for eyes from the ground to 36,000 km.
double UsualShare(double height_m, double upper_m, double top_m) {
  if (height_m > top_m) return 0.5 + 0.15 * std::exp(-(height_m - top_m) / (1.6 * upper_m));
  return std::clamp(0.98 - 0.122 * height_m / upper_m, 0.65, 0.9);
}

}  // namespace

LandBend LandBendOf(const BendingAir& air, double height_m) {
  const double height = std::max(height_m, 0.0);
  const double upper_m = air.UpperScaleHeight();
  LandBend bend{air.planet_radius_m / kMetresPerKilometre,
                LookRadius_m(air, height) / kMetresPerKilometre,
                std::min(4.1 * upper_m, air.top_m) / kMetresPerKilometre,
                0.0,
                {},
                {}};
  for (std::size_t i = 0; i < air.layers.size(); ++i) {
    const auto& [share, scale_height_m] = air.layers[i];
    bend.slope_per_km[i] = air.refractivity * share * kMetresPerKilometre / scale_height_m;
    bend.fall_per_km[i] = kMetresPerKilometre / scale_height_m;
  }
  bend.usual_per_km =
      UsualShare(height, upper_m, bend.top_km * kMetresPerKilometre) * bend.MostCurvature();
  return bend;
}

double LiftOfLand(const LandBend& bend, double eye_m, double place_m, double distance_m) {
  const auto& slope = bend.slope_per_km;
  const auto& fall = bend.fall_per_km;
  return shared::LandLift<double>(std::max(eye_m, 0.0) / kMetresPerKilometre,
                                  place_m / kMetresPerKilometre, distance_m / kMetresPerKilometre,
                                  bend.radius_km, bend.top_km, bend.usual_per_km, slope[0],
                                  slope[1], slope[2], fall[0], fall[1], fall[2]);
}

double MostLiftOfPlanet(const LandBend& bend, double eye_m, double farthest_land_m) {
  const double eye_km = std::max(eye_m, 0.0) / kMetresPerKilometre;
  const double horizon_rad = std::asin(shared::HorizonCosine(eye_km, bend.look_radius_km)) -
                             std::asin(shared::HorizonCosine(eye_km, bend.radius_km));
  return std::max(horizon_rad, LiftOfLand(bend, eye_m, 0.0, farthest_land_m));
}

}  // namespace alpenglow::atmosphere
