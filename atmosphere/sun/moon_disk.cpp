// SPDX-License-Identifier: MIT
#include "atmosphere/sun/moon_disk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/disk_light.h"
#include "atmosphere/sun/sun.h"

namespace alpenglow {
namespace {

// Light of the whole disk, relative to that of the full moon.
double MeasuredPhase(double angle_rad) {
  const double degrees = angle_rad / kRadiansPerDegree;
  return std::pow(10.0, -0.4 * (0.026 * degrees + 4e-9 * std::pow(degrees, 4.0)));
}

// The same of a sphere of Lommel and Seeliger: 1 - sin(a/2) tan(a/2) ln cot(a/4).
double SpherePhase(double angle_rad) {
  if (angle_rad < 1e-6) return 1.0;
  const double half = 0.5 * angle_rad;
  return 1.0 + std::sin(half) * std::tan(half) * std::log(std::tan(0.5 * half));
}

}  // namespace

MoonDisk MoonDiskOf(const MoonPosition& moon, const glm::dvec3& to_moon, const glm::dvec3& to_sun,
                    double earth_sun_au) {
  constexpr double kLastMeasured_rad = 150.0 * kRadiansPerDegree;
  const double angle_rad = std::min(moon.phase_angle_rad, kLastMeasured_rad);
  const double nearness = earth_sun_au / moon.sun_distance_au;
  const double full = 2.0 * kMoonGeometricAlbedo / kPi * nearness * nearness;
  return {to_moon, to_sun, moon.angular_radius_rad,
          full * MeasuredPhase(angle_rad) / SpherePhase(angle_rad)};
}

MoonDisk ApparentMoonDisk(const GeodeticPosition& place, const UtcInstant& instant,
                          double earth_sun_au) {
  const MoonPosition moon = ApparentMoonAt(place, instant);
  const LocalFrame frame(kWgs84, place);
  return MoonDiskOf(moon, DirectionFromAngles(moon.elevation_rad, moon.azimuth_rad).xyz,
                    frame.EnuFromEcef(moon.to_sun).xyz, earth_sun_au);
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
  return moon.radiance_per_irradiance * shared::LommelSeeliger(mu_lit, mu_seen);
}

}  // namespace alpenglow
