// SPDX-License-Identifier: MIT
#include "atmosphere/sun/sun.h"

#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/apparent_place.h"
#include "atmosphere/sun/refraction.h"

namespace alpenglow {

SunPosition SunAt(const GeodeticPosition& place, const UtcInstant& instant) {
  return SunAt(place, instant, DeltaT(instant));
}

SunPosition SunAt(const GeodeticPosition& place, const UtcInstant& instant, double delta_t_s) {
  const EarthAndSun bodies = EarthAndSunAt(instant, delta_t_s);
  const ApparentPlace sun = SeenFrom(place, EcefFromGcrs(instant, delta_t_s), bodies, bodies.sun);
  return {sun.elevation_rad, sun.azimuth_rad, sun.distance_au,
          std::asin(kSunRadius_m / (sun.distance_au * kAstronomicalUnit_m)), sun.direction};
}

SunPosition ApparentSunAt(const GeodeticPosition& place, const UtcInstant& instant) {
  SunPosition sun = SunAt(place, instant);
  sun.elevation_rad += RefractionFromHeight(sun.elevation_rad, place.height_m);
  return sun;
}

SunPosition ApparentSunAt(const GeodeticPosition& place, const UtcInstant& instant,
                          const BendingAir& air) {
  SunPosition sun = SunAt(place, instant);
  sun.elevation_rad += RefractionFromHeight(air, sun.elevation_rad, place.height_m);
  return sun;
}

Vector<Enu> DirectionFromAngles(double elevation_rad, double azimuth_rad) {
  const double horizontal = std::cos(elevation_rad);
  return {{horizontal * std::sin(azimuth_rad), horizontal * std::cos(azimuth_rad),
           std::sin(elevation_rad)}};
}

}  // namespace alpenglow
