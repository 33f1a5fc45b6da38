// SPDX-License-Identifier: MIT
// The moon as a disk that the sun lights: how bright it is from place to place, outside the air.
//
// Grey ground that scatters by Lommel and Seeliger (disk_light.glsl), of a brightness that makes
// the light of the whole disk that of the moon:
//
//   E(a) / E(0) = 10^(-0.4 (0.026 |a| + 4e-9 a^4)),     a the phase angle in degrees
//
// (Krisciunas, Schaefer 1991, PASP 103, 1033, equation 9, after Allen), and E(0) what a geometric
// albedo of 0.12 sends back (Cox 2000, Allen's Astrophysical Quantities, table 12.1): 0.33 lux, 5,000
// cd/m^2. Maria, colour and earthshine are left out.
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/sun/moon.h"

namespace alpenglow {

inline constexpr double kMoonGeometricAlbedo = 0.12;

/// Directions in any one frame.
struct MoonDisk {
  glm::dvec3 to_moon;  // unit, to the disk's centre
  glm::dvec3 to_sun;   // unit, from the moon
  double radius_rad;   // angular
  double
      radiance_per_irradiance;  // [1/sr], of LommelSeeliger: by the sun's irradiance at the earth
};

/// Phase angles over 150 degrees, which were never measured, are as bright a place as 150.
/// @param earth_sun_au  distance of the place from the sun, for whose irradiance the radiance is.
[[nodiscard]] MoonDisk MoonDiskOf(const MoonPosition& moon, const glm::dvec3& to_moon,
                                  const glm::dvec3& to_sun, double earth_sun_au);

/// The moon where refraction shows it from a place, in the frame east, north, up there.
[[nodiscard]] MoonDisk ApparentMoonDisk(const GeodeticPosition& place, const UtcInstant& instant,
                                        double earth_sun_au);

/// Radiance [1/sr] outside the air per unit of solar irradiance, in a direction; 0 beside the disk
/// and on its dark side.
[[nodiscard]] double MoonRadiance(const MoonDisk& moon, const glm::dvec3& direction);

}  // namespace alpenglow
