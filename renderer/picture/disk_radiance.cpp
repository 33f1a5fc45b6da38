// SPDX-License-Identifier: MIT
#include "renderer/picture/disk_radiance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/angles.h"
#include "renderer/picture/refracted_view_rays.h"

namespace alpenglow::renderer {
namespace {

/// Returns the angular distance of a direction from the centre of the sun, in solar radii; no value
/// outside the disk and where the moon covers it.
std::optional<double> PlaceOnSun(const glm::dvec3& direction, const glm::dvec3& to_sun,
                                 const glm::dvec3& to_moon, const Lighting& light) {
  // A chord is never longer than its arc.
  if (glm::length(direction - to_sun) >= light.source.radius_rad) return std::nullopt;
  const double rho = AngleBetween(direction, to_sun) / light.source.radius_rad;
  if (rho >= 1.0) return std::nullopt;
  if (light.eclipse && AngleBetween(direction, to_moon) < light.moon->radius_rad)
    return std::nullopt;
  return rho;
}

/// Returns the radiance of the refracted disk: each band of the disk is lifted by its own
/// refraction, and attenuated by the air along the bent ray.
Spectrum RefractedSunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                          const Lighting& light, const RefractedViewRays& bent,
                          const Medium& medium) {
  Spectrum disk(light.source.irradiance.size());
  // The refracted disk is not wider than a circular one.
  if (glm::length(direction - light.source.direction.seen) > 2.0 * light.source.radius_rad)
    return disk;
  const double elevation = bent.ElevationOf(direction);
  const double per_sr = 1.0 / DiskSolidAngle(light.source.radius_rad);
  for (std::size_t band = 0; band < disk.size(); ++band) {
    const auto rho =
        PlaceOnSun(bent.TrueDirection(direction, band), bent.to_sun, bent.to_moon, light);
    if (!rho) continue;
    const double left = std::exp(-bent.view.MoreOpticalDepth(elevation, band));
    disk[band] =
        static_cast<float>(per_sr * left * LimbDarkening(*rho, medium.wavelengths_nm[band])) *
        light.WholeSun()[band] * through.transmittance[band];
  }
  return disk;
}

/// Rotates a direction by Rodrigues' formula. @param turn  axis times angle.
glm::dvec3 Turned(const glm::dvec3& direction, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  if (angle == 0.0) return direction;
  const glm::dvec3 axis = turn / angle;
  return std::cos(angle) * direction + std::sin(angle) * glm::cross(axis, direction) +
         (1.0 - std::cos(angle)) * glm::dot(axis, direction) * axis;
}

/// Returns the mean radiance while the shutter is open.
double MeanMoonRadiance(const MoonDisk& moon, const glm::dvec3& turn, const glm::dvec3& direction) {
  const double angle = glm::length(turn);
  if (angle == 0.0) return MoonRadiance(moon, direction);
  const double chord = glm::length(direction - moon.direction.seen);
  if (chord > 0.5 * angle + moon.radius_rad) return 0.0;
  // One step is a twentieth of the disk.
  const int steps = 1 + static_cast<int>(angle / (0.1 * moon.radius_rad));
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    sum += MoonRadiance(moon, Turned(direction, (0.5 - (i + 0.5) / steps) * turn));
  return sum / steps;
}

/// Returns the radiance of the refracted moon (see RefractedSunDisk).
Spectrum RefractedMoon(const glm::dvec3& direction, const AirAlongRay& through,
                       const Lighting& light, const RefractedViewRays& bent) {
  Spectrum seen(light.source.irradiance.size());
  // Neither the refracted disk nor its trail is wider than the unrefracted one.
  const double widest = 2.0 * light.moon->radius_rad + glm::length(light.moon_turn);
  if (glm::length(direction - light.moon->direction.seen) > widest) return seen;
  MoonDisk moon = *light.moon;
  moon.direction.seen = bent.to_moon;
  const double elevation = bent.ElevationOf(direction);
  for (std::size_t band = 0; band < seen.size(); ++band) {
    const double radiance =
        MeanMoonRadiance(moon, light.moon_turn, bent.TrueDirection(direction, band));
    const double left = std::exp(-bent.view.MoreOpticalDepth(elevation, band));
    seen[band] = static_cast<float>(radiance * left) * light.moon_colour[band] *
                 light.source.irradiance[band] * through.transmittance[band];
  }
  return seen;
}

}  // namespace

Spectrum SunDiskRadiance(const FrameContext& frame, const glm::dvec3& direction,
                         const AirAlongRay& through) {
  const Medium& medium = frame.scene().medium();
  const Lighting& light = frame.light();
  if (frame.bent()) return RefractedSunDisk(direction, through, light, *frame.bent(), medium);
  const glm::dvec3& to_moon = light.moon ? light.moon->direction.seen : light.source.direction.seen;
  const auto rho = PlaceOnSun(direction, light.source.direction.seen, to_moon, light);
  if (!rho) return Spectrum(light.source.irradiance.size());
  Spectrum disk = (1.0F / static_cast<float>(DiskSolidAngle(light.source.radius_rad))) *
                  (light.WholeSun() * through.transmittance);
  for (std::size_t band = 0; band < disk.size(); ++band) {
    disk[band] *= static_cast<float>(LimbDarkening(*rho, medium.wavelengths_nm[band]));
  }
  return disk;
}

Spectrum MoonDiskRadiance(const FrameContext& frame, const glm::dvec3& direction,
                          const AirAlongRay& through) {
  const Lighting& light = frame.light();
  // During an eclipse, the earthshine of the moon would stand out, because the renderer has no
  // corona.
  if (!light.moon || light.eclipse) return Spectrum(light.source.irradiance.size());
  if (frame.bent()) return RefractedMoon(direction, through, light, *frame.bent());
  const double radiance = MeanMoonRadiance(*light.moon, light.moon_turn, direction);
  if (radiance == 0.0) return Spectrum(light.source.irradiance.size());
  return static_cast<float>(radiance) *
         (light.moon_colour * (light.source.irradiance * through.transmittance));
}

}  // namespace alpenglow::renderer
