// SPDX-License-Identifier: MIT
#include "viewer/paint/view_bend.h"

#include <algorithm>

#include "atmosphere/ray/bent_view.h"

namespace alpenglow::viewer {

std::optional<LandBend> BendOf(const PaintedView& view, const Medium& medium,
                               double farthest_land_m) {
  BendingAir air = GentleAirOf(medium);
  air.planet_radius_m = RadiusUnder(view.eye, medium) * kMetresPerKilometre;
  const double height_m = std::max(view.eye.place.height_m, 0.0);
  const LandBend bend = LandBendOf(air, height_m);
  if (MostLiftOfPlanet(bend, height_m, farthest_land_m) <= 0.5 * PixelAngle(view))
    return std::nullopt;
  return bend;
}

}  // namespace alpenglow::viewer
