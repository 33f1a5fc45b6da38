// SPDX-License-Identifier: MIT
#include "atmosphere/sun/sun.h"

#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/apparent_place.h"
#include "atmosphere/sun/refraction.h"

namespace alpenglow::atmosphere {

SunPosition SunAt(const GeodeticPosition& place, const UtcInstant& instant) {
  return SunAt(place, instant, DeltaT(instant));
}

SunPosition SunAt(const GeodeticPosition& place, const UtcInstant& instant, double delta_t_s) {
  const EarthAndSun bodies = EarthAndSunAt(instant, delta_t_s);
  const ApparentPlace sun = SeenFrom(place, EcefFromGcrs(instant, delta_t_s), bodies, bodies.sun);
  return {sun.elevation_rad, sun.azimuth_rad, sun.distance_au,
          std::asin(kSunRadius_m / (sun.distance_au * kAstronomicalUnit_m)), sun.direction};
}

SunPosition SunForAir(const SunPosition& seen) {
  SunPosition sun = seen;
  sun.elevation_rad -= seen.lower_for_air_rad;
  sun.lower_for_air_rad = 0.0;
  return sun;
}

SunPosition ApparentSunAt(const GeodeticPosition& place, const UtcInstant& instant) {
  return ApparentSunAt(place, instant, AlmanacAir());
}

SunPosition ApparentSunAt(const GeodeticPosition& place, const UtcInstant& instant,
                          const BendingAir& air) {
  SunPosition sun = SunAt(place, instant);
  const double lift_rad = RefractionFromHeight(air, sun.elevation_rad, place.height_m);
  sun.lower_for_air_rad = lift_rad - LiftForAir(air, sun.elevation_rad);
  sun.elevation_rad += lift_rad;
  return sun;
}

Vector<Enu> DirectionFromAngles(double elevation_rad, double azimuth_rad) {
  const double horizontal = std::cos(elevation_rad);
  return {{horizontal * std::sin(azimuth_rad), horizontal * std::cos(azimuth_rad),
           std::sin(elevation_rad)}};
}

}  // namespace alpenglow::atmosphere
