// SPDX-License-Identifier: MIT
#include "renderer/light/moon_before_sun.h"

#include "atmosphere/sun/moon.h"

namespace alpenglow::renderer {

glm::dvec3 ToMoonBefore(const SunPosition& apparent_sun, const GeodeticPosition& eye,
                        const UtcInstant& instant) {
  const MoonPosition moon = MoonAt(eye, instant);
  const double lift_rad = apparent_sun.elevation_rad - SunAt(eye, instant).elevation_rad;
  return DirectionFromAngles(moon.elevation_rad + lift_rad, moon.azimuth_rad).xyz;
}

}  // namespace alpenglow::renderer
