// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/sky_bodies.h"

namespace alpenglow::atmosphere {
namespace {

/// Raises a body, a SunPosition or MoonPosition, by refraction.
template <typename Body>
Body Lifted(Body body, double height_m, const BendingAir& air) {
  const double lift_rad = RefractionFromHeight(air, body.elevation_rad, height_m);
  body.lower_for_air_rad = lift_rad - LiftForAir(air, body.elevation_rad);
  body.elevation_rad += lift_rad;
  return body;
}

}  // namespace

SunPosition Refracted(const SunPosition& sun, double height_m, const BendingAir& air) {
  return Lifted(sun, height_m, air);
}

MoonPosition Refracted(const MoonPosition& moon, double height_m, const BendingAir& air) {
  return Lifted(moon, height_m, air);
}

double SkyBodies::CoveredLight() const {
  constexpr double kWavelength_nm = 550.0;
  return 1.0 - UncoveredLight(Eclipse(), kWavelength_nm);
}

MoonDisk SkyBodies::ApparentMoonDisk(const BendingAir& air) const {
  const MoonPosition seen = Refracted(moon, place.height_m, air);
  const LocalFrame frame(kWgs84, place);
  MoonDisk disk = MoonDiskOf(seen, DirectionFromAngles(seen.elevation_rad, seen.azimuth_rad).xyz,
                             frame.EnuFromEcef(seen.to_sun).xyz, sun.distance_au);
  disk.to_moon_for_air =
      DirectionFromAngles(seen.elevation_rad - seen.lower_for_air_rad, seen.azimuth_rad).xyz;
  return disk;
}

SkyBodies SkyBodiesAt(const GeodeticPosition& place, const UtcInstant& instant) {
  return {place, instant, SunAt(place, instant), MoonAt(place, instant)};
}

}  // namespace alpenglow::atmosphere
