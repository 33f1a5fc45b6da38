// SPDX-License-Identifier: MIT
#include "atmosphere/sun/moon_disk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/disk_light.h"
#include "atmosphere/sun/moon_reflectance.h"
#include "atmosphere/sun/sun.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kWavelength_nm = 550.0;

// Light of a sphere of Lommel and Seeliger, relative to that when full: 1 - sin(a/2) tan(a/2) ln cot(a/4).
double SpherePhase(double angle_rad) {
  if (angle_rad < 1e-6) return 1.0;
  const double half = 0.5 * angle_rad;
  return 1.0 + std::sin(half) * std::tan(half) * std::log(std::tan(0.5 * half));
}

// Of the earth at the moon, per unit of the sun's there.
double EarthIrradiance(const MoonPosition& moon) {
  constexpr double kGeometricAlbedo = 0.37;
  const double angle = kPi - moon.phase_angle_rad;
  const double share = kEarthMeanRadius_m / moon.distance_m;
  return kGeometricAlbedo * share * share * (std::sin(angle) + (kPi - angle) * std::cos(angle)) /
         kPi;
}

// Sunlight at the moon, per unit of that at the earth.
double SunlightAt(const MoonPosition& moon, double earth_sun_au) {
  const double nearness = earth_sun_au / moon.sun_distance_au;
  return nearness * nearness;
}

}  // namespace

MoonDisk MoonDiskOf(const MoonPosition& moon, const glm::dvec3& to_moon, const glm::dvec3& to_sun,
                    double earth_sun_au) {
  constexpr double kLastMeasured_rad = 150.0 * kRadiansPerDegree;
  const double angle_rad = std::min(moon.phase_angle_rad, kLastMeasured_rad);
  const double sunlight = SunlightAt(moon, earth_sun_au);
  const double seen = MoonReflectance(angle_rad, kWavelength_nm) / kPi;
  const double earthlit = MoonReflectance(0.0, kWavelength_nm) / kPi;
  return {to_moon,
          to_sun,
          moon.angular_radius_rad,
          2.0 * sunlight * seen / SpherePhase(angle_rad),
          sunlight * EarthIrradiance(moon) * earthlit,
          to_moon};
}

double MoonIrradiance(const MoonPosition& moon, double earth_sun_au, double wavelength_nm) {
  const double sine = std::sin(moon.angular_radius_rad);
  return sine * sine * SunlightAt(moon, earth_sun_au) *
         MoonReflectance(moon.phase_angle_rad, wavelength_nm);
}

MoonDisk ApparentMoonDisk(const GeodeticPosition& place, const UtcInstant& instant,
                          double earth_sun_au, const BendingAir& air) {
  const MoonPosition moon = ApparentMoonAt(place, instant, air);
  const LocalFrame frame(kWgs84, place);
  MoonDisk disk = MoonDiskOf(moon, DirectionFromAngles(moon.elevation_rad, moon.azimuth_rad).xyz,
                             frame.EnuFromEcef(moon.to_sun).xyz, earth_sun_au);
  disk.to_moon_for_air =
      DirectionFromAngles(moon.elevation_rad - moon.lower_for_air_rad, moon.azimuth_rad).xyz;
  return disk;
}

double MoonRadiance(const MoonDisk& moon, const glm::dvec3& direction) {
  if (glm::dot(direction, moon.to_moon) <= 0.0) return 0.0;
  // Where on the disk, in radii; over half a degree parallel rays serve.
  const glm::dvec3 beside = direction - moon.to_moon;
  const glm::dvec3 at =
      (beside - glm::dot(beside, moon.to_moon) * moon.to_moon) / std::sin(moon.radius_rad);
  const double squared = glm::dot(at, at);
  if (squared >= 1.0) return 0.0;
  const double mu_seen = std::sqrt(1.0 - squared);
  const double mu_lit = glm::dot(at - mu_seen * moon.to_moon, moon.to_sun);
  return moon.radiance_per_irradiance * shared::LommelSeeliger(mu_lit, mu_seen) +
         moon.earthshine_per_irradiance;
}

}  // namespace alpenglow::atmosphere
