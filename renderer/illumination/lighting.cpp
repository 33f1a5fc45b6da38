// SPDX-License-Identifier: MIT
#include "renderer/illumination/lighting.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

glm::dvec3 ToMoonBefore(const SunInSky& apparent_sun, const SkyBodies& bodies) {
  const double lift_rad = apparent_sun.elevation_rad() - bodies.sun.elevation_rad();
  return EnuFromAngles(bodies.moon.elevation_rad() + lift_rad, bodies.moon.azimuth_rad()).xyz;
}

Lighting LightingOf(const SunInSky& sun, const UtcTime& instant, const Place& place,
                    const Medium& medium, double wetness) {
  return LightingOf(SunlightOf(sun, medium), instant, place, medium, wetness);
}

Lighting LightingOf(const DistantLight& light, const UtcTime& instant, const Place& place,
                    const Medium& medium, double wetness) {
  const MountainCover cover = CoverInSeason(place, instant.modified_julian_day);
  return {light, MountainSurface(medium.wavelengths_nm, cover, wetness), SeaTime(instant)};
}

Lighting Lighting::EclipsedBy(const EclipsedDisk& disk,
                              const std::vector<double>& wavelengths_nm) const {
  constexpr double kCorona = 1e-6;
  Lighting eclipsed = *this;
  eclipsed.eclipse = EclipsedSun{disk, source.irradiance};
  for (std::size_t band = 0; band < source.irradiance.size(); ++band) {
    const double left = std::max(UncoveredLight(disk, wavelengths_nm[band]), kCorona);
    eclipsed.source.irradiance[band] = static_cast<float>(left) * source.irradiance[band];
  }
  return eclipsed;
}

std::vector<DistantLight> Lighting::Lights() const {
  std::vector<DistantLight> lights;
  if (shows) lights.push_back(source);
  if (moonlight) lights.push_back(*moonlight);
  return lights;
}

Lighting Lighting::By(const DistantLight& light) const {
  Lighting alone = *this;
  alone.source = light;
  alone.moon = std::nullopt;
  alone.eclipse = std::nullopt;
  alone.moonlight = std::nullopt;
  alone.night = nullptr;
  alone.shows = true;
  alone.on_terrain = nullptr;
  return alone;
}

Spectrum MoonColour(const MoonDisk& moon, const std::vector<double>& wavelengths_nm) {
  const double phase_rad =
      std::acos(std::clamp(-glm::dot(moon.direction.seen, moon.to_sun), -1.0, 1.0));
  const double grey = MoonReflectance(phase_rad, 550.0);
  Spectrum colour(wavelengths_nm.size());
  for (std::size_t band = 0; band < colour.size(); ++band)
    colour[band] = static_cast<float>(MoonReflectance(phase_rad, wavelengths_nm[band]) / grey);
  return colour;
}

DistantLight MoonlightOf(const MoonDisk& disk, const SkyBodies& bodies, const Spectrum& colour,
                         const Spectrum& sun) {
  const double share = MoonIrradiance(bodies.moon, bodies.sun.distance_au, 550.0);
  return {LightSource::kMoon, disk.direction, disk.radius_rad,
          static_cast<float>(share) * (colour * sun)};
}

double DepressionOfDarkAir(double altitude_m, double radius_m, double atmosphere_height_m) {
  const auto dip = [&](double height_m) {
    const double over_m = std::max(height_m, 0.0);
    return DipOfHorizon(over_m, radius_m + over_m);
  };
  return dip(altitude_m) + 2.0 * dip(atmosphere_height_m) + kRadiansPerDegree;
}

}  // namespace alpenglow::renderer
