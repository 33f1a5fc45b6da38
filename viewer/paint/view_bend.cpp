// SPDX-License-Identifier: MIT
#include "viewer/paint/view_bend.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow {

std::optional<LandBend> BendOf(const PaintedView& view, const Medium& medium,
                               double farthest_land_m) {
  BendingAir air = GentleAirOf(medium);
  air.planet_radius_m = RadiusUnder(view.eye, medium) * kMetresPerKilometre;
  const double height_m = std::max(view.eye.place.height_m, 0.0);
  const LandBend bend = LandBendOf(air, height_m);
  const double height_km = height_m / kMetresPerKilometre;
  const double horizon_rad = std::asin(shared::HorizonCosine(height_km, bend.look_radius_km)) -
                             std::asin(shared::HorizonCosine(height_km, bend.radius_km));
  // Lift by rays that are as much bent as those at the ground.
  const double land_rad = 0.5 * bend.MostCurvature() * farthest_land_m / kMetresPerKilometre;
  if (std::max(horizon_rad, land_rad) <= 0.5 * PixelAngle(view)) return std::nullopt;
  return bend;
}

}  // namespace alpenglow
