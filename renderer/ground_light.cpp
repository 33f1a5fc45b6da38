// SPDX-License-Identifier: MIT
#include "renderer/ground_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/constants.h"
#include "atmosphere/sun_disk.h"
#include "renderer/media_light.h"

namespace alpenglow {
namespace {

/// A direction to the sun's disk, uniform in its area.
glm::dvec3 TowardsDisk(const Lighting& light, std::array<double, 2> sample) {
  const glm::dvec3 side = glm::normalize(glm::cross(light.to_sun, glm::dvec3(0.3, -0.5, 0.8)));
  const double rho = light.sun_radius_rad * std::sqrt(sample[0]);
  const double angle = 2.0 * kPi * sample[1];
  return glm::normalize(light.to_sun + rho * (std::cos(angle) * side +
                                              std::sin(angle) * glm::cross(light.to_sun, side)));
}

}  // namespace

Lighting LightingOf(const SunPosition& sun, const UtcInstant& instant, double latitude_rad,
                    const Medium& medium) {
  const MountainCover cover = CoverInSeason(latitude_rad, instant.modified_julian_day);
  Lighting light{DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz,
                 sun.angular_radius_rad, BandLight(medium.solar_irradiance.size()),
                 MountainSurface(medium.wavelengths_nm, cover)};
  for (std::size_t band = 0; band < light.irradiance.count; ++band) {
    light.irradiance[band] =
        static_cast<float>(medium.solar_irradiance[band] / (sun.distance_au * sun.distance_au));
  }
  return light;
}

GroundLight::GroundLight(const SceneGround& ground, const SceneGeometry& geometry,
                         const AirIntegrator<float>& air, const DiffuseLight& diffuse,
                         const LampLight& lamps, const HorizonsOnDemand& horizons)
    : ground_(ground),
      geometry_(geometry),
      air_(air),
      diffuse_(diffuse),
      lamps_(lamps),
      horizons_(horizons) {}

std::shared_ptr<const TerrainLight> GroundLight::OnTerrain(const Lighting& light) const {
  if (!light.effects.Has(Effect::kHorizons) || !light.effects.Has(Effect::kSkylight))
    return nullptr;
  const std::shared_ptr<const TerrainHorizons> horizons = horizons_.Get();
  if (!horizons) return nullptr;
  auto on_terrain = std::make_shared<TerrainLight>(horizons, air_, diffuse_, light.to_sun);
  if (light.effects.Has(Effect::kBounce)) {
    on_terrain->AddSlopes(
        air_.medium(),
        [&](const SlopePlace& place) { return SentToSlopes(place, light, *on_terrain); },
        light.to_sun.z);
  }
  return on_terrain;
}

BandLight GroundLight::SentToSlopes(const SlopePlace& place, const Lighting& light,
                                    const TerrainLight& sky) const {
  const double cell_m = sky.horizons().views().heights().cell_m;
  Hit hit;
  hit.kind = HitKind::kTerrain;
  hit.normal = hit.mesh_normal = hit.geometric_normal = place.normal;
  hit.point = place.point + 0.01 * cell_m * place.normal;  // nodes lie in the surface, not on it
  hit.footprint_m = cell_m;
  const LocalSun sun = LocalSunAt(hit.point, light);
  BandLight irradiance = sky.Irradiance({hit.point, hit.normal, sun.up, sun.altitude_m, sun.mu_s});
  if (const auto direct = SunIrradiance(hit, light, sun, {0.0, 0.0}))
    irradiance = irradiance + *direct;
  return static_cast<float>(1.0 / kPi) * (AlbedoOf(hit, light, sun.up) * irradiance);
}

LocalSun LocalSunAt(const SceneGeometry& geometry, const glm::dvec3& point,
                    const glm::dvec3& to_sun, double sun_radius_rad) {
  const double altitude = std::max(geometry.AltitudeOf(point), 0.0);
  const double r = geometry.radius_m();
  const glm::dvec3 up = geometry.UpAt(point);
  const double mu_s = std::clamp(glm::dot(up, to_sun), -1.0, 1.0);
  const double horizon = -std::sqrt(altitude * (2.0 * r + altitude)) / (r + altitude);
  const VisibleDisk disk = DiskOverHorizon(mu_s, horizon, sun_radius_rad);
  return {altitude, up, mu_s, disk.fraction, disk.mu_s_effective};
}

LocalSun GroundLight::LocalSunAt(const glm::dvec3& point, const Lighting& light) const {
  return alpenglow::LocalSunAt(geometry_, point, light.to_sun, light.sun_radius_rad);
}

double GroundLight::LitCosine(const Hit& hit, const Lighting& light, const LocalSun& sun,
                              std::array<double, 2> disk_sample) const {
  const glm::dvec3 to_disk = TowardsDisk(light, disk_sample);
  const double cosine = glm::dot(hit.normal, to_disk);
  const bool faces =
      cosine > 0.0 && glm::dot(hit.geometric_normal, to_disk) > 0.0 && sun.visible_fraction > 0.0;
  const bool occluded = faces && ground_.terrain && light.effects.Has(Effect::kShadows) &&
                        ground_.terrain->Occluded(hit.point, hit.geometric_normal, to_disk,
                                                  std::numeric_limits<double>::infinity());
  return faces && !occluded ? cosine : 0.0;
}

BandLight GroundLight::SkyIrradiance(const Hit& hit, const Lighting& light,
                                     const LocalSun& sun) const {
  const glm::dvec3 flat_sun = light.to_sun - sun.mu_s * sun.up;
  const double normal_mu = std::clamp(glm::dot(hit.normal, sun.up), -1.0, 1.0);
  const glm::dvec3 flat_normal = hit.normal - normal_mu * sun.up;
  const double lengths = glm::length(flat_sun) * glm::length(flat_normal);
  const double azimuth =
      lengths > 1e-9 ? std::clamp(glm::dot(flat_sun, flat_normal) / lengths, -1.0, 1.0) : 1.0;
  const BandLight clear =
      light.on_terrain && hit.kind == HitKind::kTerrain
          ? light.on_terrain->Irradiance({hit.point, hit.normal, sun.up, sun.altitude_m, sun.mu_s})
          : diffuse_.Irradiance(sun.altitude_m, sun.mu_s, normal_mu, azimuth);
  if (light.media == nullptr) return clear;
  const SkyThroughFog fog = light.media->SkyOnSurface(sun.altitude_m, normal_mu);
  return fog.left * clear + fog.added;
}

BandLight GroundLight::AlbedoOf(const Hit& hit, const Lighting& light, const glm::dvec3& up) const {
  if (hit.kind == HitKind::kTerrain) {
    return light.surface.Albedo(geometry_.GroundAt(hit.point, hit.footprint_m),
                                glm::dot(hit.mesh_normal, up));
  }
  BandLight albedo(air_.bands());
  for (std::size_t band = 0; band < albedo.count; ++band) {
    albedo[band] = static_cast<float>(air_.medium().ground_albedo[band]);
  }
  return albedo;
}

std::optional<BandLight> GroundLight::SunIrradiance(const Hit& hit, const Lighting& light,
                                                    const LocalSun& sun,
                                                    std::array<double, 2> disk_sample) const {
  const double cosine = LitCosine(hit, light, sun, disk_sample);
  if (cosine <= 0.0) return std::nullopt;
  const BandLight clear = static_cast<float>(sun.visible_fraction * cosine) *
                          air_.TransmittanceToSpace(sun.altitude_m, sun.mu_s_effective);
  if (light.media == nullptr) return clear;
  return clear * light.media->SunLeft(hit.point, TowardsDisk(light, disk_sample));
}

GroundRadiance GroundLight::Towards(const Hit& hit, const Lighting& light, const LampNodes& near,
                                    std::array<double, 2> disk_sample) const {
  const LocalSun sun = LocalSunAt(hit.point, light);
  GroundRadiance sent;
  BandLight irradiance(air_.bands());
  if (const auto direct = SunIrradiance(hit, light, sun, disk_sample)) {
    irradiance = *direct;
    sent.sun_visibility = static_cast<float>(sun.visible_fraction);
  }
  if (light.effects.Has(Effect::kSkylight))
    irradiance = irradiance + SkyIrradiance(hit, light, sun);
  sent.albedo = AlbedoOf(hit, light, sun.up);
  const BandLight lambert = static_cast<float>(1.0 / kPi) * sent.albedo;
  sent.natural = lambert * (light.irradiance * irradiance);
  sent.lamps = lambert * lamps_.OnSurface(near, {hit.point, hit.normal, hit.geometric_normal});
  return sent;
}

}  // namespace alpenglow
