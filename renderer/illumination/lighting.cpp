// SPDX-License-Identifier: MIT
#include "renderer/illumination/lighting.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"

namespace alpenglow::renderer {

glm::dvec3 ToMoonBefore(const SunPosition& apparent_sun, const SkyBodies& bodies) {
  const double lift_rad = apparent_sun.elevation_rad - bodies.sun.elevation_rad;
  return DirectionFromAngles(bodies.moon.elevation_rad + lift_rad, bodies.moon.azimuth_rad).xyz;
}

Lighting LightingOf(const SunPosition& sun, const UtcInstant& instant,
                    const GeodeticPosition& place, const Medium& medium, double wetness) {
  const MountainCover cover = CoverInSeason(place, instant.modified_julian_day);
  const SunPosition for_air = SunForAir(sun);
  Lighting light{DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz,
                 DirectionFromAngles(for_air.elevation_rad, for_air.azimuth_rad).xyz,
                 sun.angular_radius_rad,
                 BandLight(medium.solar_irradiance.size()),
                 MountainSurface(medium.wavelengths_nm, cover, wetness),
                 SeaTime(instant)};
  for (std::size_t band = 0; band < light.irradiance.count; ++band) {
    light.irradiance[band] =
        static_cast<float>(medium.solar_irradiance[band] / (sun.distance_au * sun.distance_au));
  }
  return light;
}

Lighting Lighting::EclipsedBy(const EclipsedDisk& disk,
                              const std::vector<double>& wavelengths_nm) const {
  constexpr double kCorona = 1e-6;
  Lighting eclipsed = *this;
  eclipsed.eclipse = EclipsedSun{disk, irradiance};
  for (std::size_t band = 0; band < irradiance.count; ++band) {
    const double left = std::max(UncoveredLight(disk, wavelengths_nm[band]), kCorona);
    eclipsed.irradiance[band] = static_cast<float>(left) * irradiance[band];
  }
  return eclipsed;
}

std::vector<DistantLight> Lighting::Lights() const {
  std::vector<DistantLight> lights;
  if (shows) lights.push_back(Sun());
  if (moonlight) lights.push_back(*moonlight);
  return lights;
}

Lighting Lighting::By(const DistantLight& light) const {
  Lighting alone = *this;
  alone.to_sun = light.to_light;
  alone.to_sun_for_air = light.to_light_for_air;
  alone.sun_radius_rad = light.radius_rad;
  alone.irradiance = light.irradiance;
  alone.moon = std::nullopt;
  alone.eclipse = std::nullopt;
  alone.moonlight = std::nullopt;
  alone.night = nullptr;
  alone.shows = true;
  alone.on_terrain = nullptr;
  return alone;
}

BandLight MoonColour(const MoonDisk& moon, const std::vector<double>& wavelengths_nm) {
  const double phase_rad = std::acos(std::clamp(-glm::dot(moon.to_moon, moon.to_sun), -1.0, 1.0));
  const double grey = MoonReflectance(phase_rad, 550.0);
  BandLight colour(wavelengths_nm.size());
  for (std::size_t band = 0; band < colour.count; ++band)
    colour[band] = static_cast<float>(MoonReflectance(phase_rad, wavelengths_nm[band]) / grey);
  return colour;
}

DistantLight MoonlightOf(const MoonDisk& disk, const SkyBodies& bodies, const BandLight& colour,
                         const BandLight& sun) {
  const double share = MoonIrradiance(bodies.moon, bodies.sun.distance_au, 550.0);
  return {disk.to_moon, disk.to_moon_for_air, disk.radius_rad,
          static_cast<float>(share) * (colour * sun)};
}

double DepressionOfDarkAir(double altitude_m, double radius_m, double atmosphere_height_m) {
  const auto dip = [&](double height_m) {
    return std::acos(radius_m / (radius_m + std::max(height_m, 0.0)));
  };
  return dip(altitude_m) + 2.0 * dip(atmosphere_height_m) + kRadiansPerDegree;
}

LocalSun LocalSunAt(const SceneGeometry& geometry, const glm::dvec3& point,
                    const DistantLight& sun) {
  const double altitude = std::max(geometry.AltitudeOf(point), 0.0);
  const double r = geometry.radius_m();
  const glm::dvec3 up = geometry.UpAt(point);
  const auto cosine = [&](const glm::dvec3& to) { return std::clamp(glm::dot(up, to), -1.0, 1.0); };
  const double horizon = -std::sqrt(altitude * (2.0 * r + altitude)) / (r + altitude);
  const VisibleDisk disk = DiskOverHorizon(cosine(sun.to_light), horizon, sun.radius_rad);
  return {altitude, up, cosine(sun.to_light_for_air), disk.fraction, disk.mu_s_effective};
}

}  // namespace alpenglow::renderer
