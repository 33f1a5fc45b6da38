// SPDX-License-Identifier: MIT
// The moon as a disk that the sun lights: how bright it is from place to place, outside the air.
//
// Ground that scatters by Lommel and Seeliger (disk_light.glsl), of a brightness that makes the
// light of the whole disk that of the moon (moon_reflectance.h): a full moon of 0.3 lux, before the
// air. Beside the sun the earth lights it, whose disk there is (R / d)^2 of a hemisphere, of a
// geometric albedo of 0.37 (Cox 2000, Allen's Astrophysical Quantities, table 12.1), full when the
// moon is new, as a sphere of Lambert:
//
//   E_earth / E_sun = 0.37 (R / d)^2 (sin a' + (pi - a') cos a') / pi,     a' = pi - a
//
// and the moon sends that back as when it is full: earthshine. Maria are left out.
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/sun/moon.h"

namespace alpenglow::atmosphere {

/// Directions in any one frame.
struct MoonDisk {
  glm::dvec3 to_moon;  // unit, to the disk's centre
  glm::dvec3 to_sun;   // unit, from the moon
  double radius_rad;   // angular
  double
      radiance_per_irradiance;  // [1/sr], of LommelSeeliger: by the sun's irradiance at the earth
  double earthshine_per_irradiance = 0.0;  // [1/sr], of the whole disk, even over it
  glm::dvec3 to_moon_for_air{0.0};         // unit, of straight rays that light the air (sun.h)
};

/// At 550 nm. Phase angles over 150 degrees, which were never measured, are as bright a place as
/// 150.
/// @param earth_sun_au  distance of the place from the sun, for whose irradiance the radiance is.
[[nodiscard]] MoonDisk MoonDiskOf(const MoonPosition& moon, const glm::dvec3& to_moon,
                                  const glm::dvec3& to_sun, double earth_sun_au);

/// The moon where the refraction of air that bends gently shows it from a place, in the frame east,
/// north, up there.
[[nodiscard]] MoonDisk ApparentMoonDisk(const GeodeticPosition& place, const UtcInstant& instant,
                                        double earth_sun_au, const BendingAir& air);

/// Radiance [1/sr] outside the air per unit of solar irradiance, in a direction; 0 beside the disk,
/// on its dark side that of earthshine.
[[nodiscard]] double MoonRadiance(const MoonDisk& moon, const glm::dvec3& direction);

/// Irradiance of the whole moon outside the air, per unit of the sun's there, at a wavelength.
[[nodiscard]] double MoonIrradiance(const MoonPosition& moon, double earth_sun_au,
                                    double wavelength_nm);

}  // namespace alpenglow::atmosphere
