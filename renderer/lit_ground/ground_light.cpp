// SPDX-License-Identifier: MIT
#include "renderer/lit_ground/ground_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/illumination/polarised_axes.h"

namespace alpenglow::renderer {
namespace {

// Returns whether terrain can stand between the ground at the hit and the sky.
bool SeesTerrain(const Hit& hit, const Lighting& light) {
  return hit.kind == HitKind::kTerrain && light.on_terrain && light.on_terrain->horizons();
}

}  // namespace

GroundLight::GroundLight(const GroundParts& parts, const SolvedAir& air)
    : parts_(parts), air_(air) {}

std::shared_ptr<const TerrainIrradiance> GroundLight::OnTerrain(const GroundSources& from) const {
  const Lighting& light = from.light;
  if (!light.effects.Has(Effect::kSkylight)) return nullptr;
  const std::shared_ptr<const TerrainHorizons> horizons =
      light.effects.Has(Effect::kHorizons) ? parts_.horizons.Get() : nullptr;
  if (!horizons && !parts_.material.HasGloss()) return nullptr;
  auto on_terrain = std::make_shared<TerrainIrradiance>(horizons, air_.single_scattering(),
                                                        air_.multiple_scattering(),
                                                        light.source.direction.for_air);
  if (horizons && light.effects.Has(Effect::kBounce)) {
    on_terrain->AddSlopes(
        air_.medium(),
        [&](const SlopePlace& place) { return SentToSlopes(place, from, *on_terrain); },
        light.source.direction.for_air.z);
  }
  return on_terrain;
}

Spectrum GroundLight::SentToSlopes(const SlopePlace& place, const GroundSources& from,
                                   const TerrainIrradiance& sky) const {
  const Lighting& light = from.light;
  const double cell_m = sky.horizons()->views().heights().cell_m;
  Hit hit;
  hit.kind = HitKind::kTerrain;
  hit.normal = hit.mesh_normal = hit.geometric_normal = place.normal;
  hit.point = hit.smooth_point =
      place.point + 0.01 * cell_m * place.normal;  // the nodes of the slopes lie inside the surface
  hit.footprint_m = cell_m;
  const LocalLight sun = LocalLightAt(hit.point, light);
  Spectrum irradiance =
      sky.Irradiance({hit.point, hit.normal, sun.up, sun.altitude_m, sun.mu_s_for_air});
  if (const auto direct = SunIrradiance(hit, from, sun, light.source.direction.seen))
    irradiance = irradiance + *direct;
  // The albedo for a view at 60 degrees stands for the mean over directions.
  return static_cast<float>(1.0 / kPi) *
         (PatchAt(hit, light, sun.up, 1.0).BodyAlbedo(0.5) * irradiance);
}

LocalLight GroundLight::LocalLightAt(const glm::dvec3& point, const Lighting& light) const {
  return renderer::LocalLightAt(parts_.geometry, point, light.source);
}

double GroundLight::LitCosine(const Hit& hit, const Lighting& light, const LocalLight& sun,
                              const glm::dvec3& to_disk) const {
  const double cosine = glm::dot(hit.normal, to_disk);
  // Test whether the smooth surface faces the sun. The geometric normal of the triangle does not
  // matter: the shadow ray starts on the smooth surface (TerrainHit::smooth_point) or meets the
  // triangle. Testing the triangle's own normal would draw facets along the edge of the shade
  // (Hanika 2021, Ray Tracing Gems II, ch. 4).
  const bool faces =
      cosine > 0.0 && glm::dot(hit.mesh_normal, to_disk) > 0.0 && sun.visible_fraction > 0.0;
  const bool occluded =
      faces && parts_.ground.terrain && light.effects.Has(Effect::kShadows) &&
      parts_.ground.terrain->Occluded(hit.smooth_point, hit.geometric_normal, to_disk,
                                      std::numeric_limits<double>::infinity());
  const bool behind_sphere = faces && parts_.spheres != nullptr &&
                             light.effects.Has(Effect::kShadows) &&
                             FirstSphereOn(*parts_.spheres, hit.smooth_point, to_disk).has_value();
  return faces && !occluded && !behind_sphere ? cosine : 0.0;
}

Spectrum GroundLight::SkyIrradiance(const Hit& hit, const GroundSources& from,
                                    const LocalLight& sun) const {
  const Lighting& light = from.light;
  const glm::dvec3 flat_sun = light.source.direction.for_air - sun.mu_s_for_air * sun.up;
  const double normal_mu = std::clamp(glm::dot(hit.normal, sun.up), -1.0, 1.0);
  const glm::dvec3 flat_normal = hit.normal - normal_mu * sun.up;
  const double lengths = glm::length(flat_sun) * glm::length(flat_normal);
  const double azimuth =
      lengths > 1e-9 ? std::clamp(glm::dot(flat_sun, flat_normal) / lengths, -1.0, 1.0) : 1.0;
  const Spectrum clear = SeesTerrain(hit, light)
                             ? light.on_terrain->Irradiance({hit.smooth_point, hit.normal, sun.up,
                                                             sun.altitude_m, sun.mu_s_for_air})
                             : air_.multiple_scattering().Irradiance(
                                   sun.altitude_m, sun.mu_s_for_air, normal_mu, azimuth);
  const bool has_clouds = from.clouds != nullptr && light.effects.Has(Effect::kCloudGlow);
  if (from.media == nullptr && !has_clouds) return clear;
  SkyThroughMedia sky = SkyThroughMedia::Clear(air_.bands());
  if (has_clouds) sky = from.clouds->SkyOnSurface(hit.point, normal_mu, sky);
  if (from.media != nullptr) sky = from.media->SkyOnSurface(sun.altitude_m, normal_mu, sky);
  return sky.left * clear + sky.added;
}

GroundPatch GroundLight::PatchAt(const Hit& hit, const Lighting& light, const glm::dvec3& up,
                                 double cosine) const {
  GroundPoint at = parts_.geometry.GroundAt(hit.point, hit.footprint_m, cosine);
  at.normal_north = parts_.geometry.pattern().Northward(hit.mesh_normal, up);
  at.sea_s = light.sea_s;
  if (hit.kind == HitKind::kTerrain) {
    return parts_.material.OfTerrain(at, hit.point, glm::dot(hit.mesh_normal, up), light.surface);
  }
  if (parts_.geometry.HasTerrain())
    return parts_.material.OfPlanet(at, light.surface.Albedo(at, glm::dot(hit.mesh_normal, up)));
  Spectrum albedo(air_.bands());
  for (std::size_t band = 0; band < albedo.size(); ++band)
    albedo[band] = static_cast<float>(air_.medium().ground_albedo[band]);
  return parts_.material.OfPlanet(at, albedo);
}

Spectrum GroundLight::Mirrored(const SeenGround& seen, const GroundSources& from,
                               const LocalLight& sun) const {
  Spectrum sum(air_.bands());
  const auto rays = seen.patch.Mirrored(seen.hit.normal, seen.to_eye);
  for (const MirroredRay& ray : rays.All())
    sum = sum + static_cast<float>(ray.weight) * SeenIn(ray, seen.hit, from, sun);
  return sum;
}

Spectrum GroundLight::SeenIn(const MirroredRay& ray, const Hit& hit, const GroundSources& from,
                             const LocalLight& sun) const {
  const TerrainIrradiance& light = *from.light.on_terrain;
  const SlopePoint at{hit.smooth_point, hit.normal, sun.up, sun.altitude_m, sun.mu_s_for_air};
  const bool sees_terrain = SeesTerrain(hit, from.light);
  const Spectrum seen = sees_terrain ? light.Radiance(at, ray.direction, ray.spread)
                                     : light.SkyRadiance(at, ray.direction);
  if (from.clouds == nullptr) return seen;
  const double sky_share = sees_terrain ? light.SkyShare(at, ray.direction, ray.spread) : 1.0;
  if (sky_share <= 0.0) return seen;
  const Spectrum clear = sees_terrain ? light.SkyRadiance(at, ray.direction) : seen;
  const Spectrum cloudy = from.clouds->OverSky(hit.smooth_point, ray.direction, clear);
  return seen + static_cast<float>(sky_share) * (cloudy + -1.0F * clear);
}

std::optional<Spectrum> GroundLight::SunIrradiance(const Hit& hit, const GroundSources& from,
                                                   const LocalLight& sun,
                                                   const glm::dvec3& to_disk) const {
  const double cosine = LitCosine(hit, from.light, sun, to_disk);
  if (cosine <= 0.0) return std::nullopt;
  return BeamThrough(hit.point, from, sun, to_disk, cosine);
}

std::optional<Spectrum> GroundLight::InAir(const glm::dvec3& point,
                                           const GroundSources& from) const {
  const glm::dvec3& to_light = from.light.source.direction.seen;
  const LocalLight sun = LocalLightAt(point, from.light);
  const bool is_occluded = parts_.ground.terrain && from.light.effects.Has(Effect::kShadows) &&
                           parts_.ground.terrain->Occluded(point, to_light, to_light,
                                                           std::numeric_limits<double>::infinity());
  if (is_occluded || sun.visible_fraction <= 0.0) return std::nullopt;
  return BeamThrough(point, from, sun, to_light, 1.0);
}

Spectrum GroundLight::BeamThrough(const glm::dvec3& point, const GroundSources& from,
                                  const LocalLight& sun, const glm::dvec3& to_disk,
                                  double cosine) const {
  const bool is_shaded = from.clouds != nullptr && from.light.effects.Has(Effect::kCloudShadows);
  const double past_clouds = is_shaded ? from.clouds->shadow().Transmittance(point) : 1.0;
  const Spectrum clear = static_cast<float>(sun.visible_fraction * cosine * past_clouds) *
                         air_.BeamLeft(sun.altitude_m, sun.mu_s_effective);
  if (from.media == nullptr) return clear;
  return clear * from.media->BeamLeft(point, to_disk);
}

SeenGround GroundLight::SeenFrom(const Hit& hit, const glm::dvec3& to_eye,
                                 const Lighting& light) const {
  const glm::dvec3 up = parts_.geometry.UpAt(hit.point);
  SeenGround seen{PatchAt(hit, light, up, glm::dot(hit.mesh_normal, to_eye)), hit, {}, up, to_eye};
  if (seen.patch.IsWater()) {
    seen.hit.mesh_normal = up;
    const GroundPattern& pattern = parts_.geometry.pattern();
    seen.hit.normal = pattern.FromPattern(seen.patch.WaterNormal(pattern.ToPattern(up)));
  }
  const double mu_eye = AnglesBetween(seen.hit.normal, seen.hit.normal, to_eye).mu_eye;
  seen.albedo = seen.patch.BodyAlbedo(mu_eye);
  return seen;
}

NaturalRadiance GroundLight::Natural(const SeenGround& seen, const GroundSources& from,
                                     std::array<double, 2> disk_sample) const {
  const Lighting& light = from.light;
  const LocalLight sun = LocalLightAt(seen.hit.point, light);
  NaturalRadiance sent{Spectrum(air_.bands())};
  const glm::dvec3 to_disk =
      TowardsDisk(light.source.direction.seen, light.source.radius_rad, disk_sample);
  if (const auto direct = SunIrradiance(seen.hit, from, sun, to_disk)) {
    sent.radiance = seen.patch.Brdf(AnglesBetween(seen.hit.normal, to_disk, seen.to_eye)) * *direct;
    sent.disk_visibility = static_cast<float>(sun.visible_fraction);
  }
  if (light.effects.Has(Effect::kSkylight)) {
    sent.radiance = sent.radiance + static_cast<float>(1.0 / kPi) *
                                        (seen.albedo * SkyIrradiance(seen.hit, from, sun));
    if (seen.patch.IsGlossy() && light.on_terrain)
      sent.radiance = sent.radiance + Mirrored(seen, from, sun);
  }
  sent.radiance = light.source.irradiance * sent.radiance;
  return sent;
}

Spectrum GroundLight::OfLamps(const SeenGround& seen, const LampNodes& near) const {
  const Hit& at = seen.hit;
  return static_cast<float>(1.0 / kPi) *
         (seen.albedo * parts_.lamps.OnSurface(
                            near, {at.point, at.smooth_point, at.normal, at.geometric_normal}));
}

Spectrum GroundLight::OfGlow(const SeenGround& seen, const MediaLight& media) const {
  const Hit& at = seen.hit;
  const auto sees = [&](const glm::dvec3& place) {
    return !parts_.lamps.Shades(place, {at.point, at.smooth_point, at.normal, at.geometric_normal});
  };
  return static_cast<float>(1.0 / kPi) *
         (seen.albedo * media.GlowOnSurface(at.point, at.normal, sees));
}

PolarisedLight GroundLight::Polarised(const SeenGround& seen, const GroundSources& from,
                                      const ViewAxes& axes,
                                      std::array<double, 2> disk_sample) const {
  const Lighting& light = from.light;
  const glm::dvec3& to_eye = seen.to_eye;
  PolarisedLight sum{Spectrum(air_.bands()), Spectrum(air_.bands())};
  if (!seen.patch.IsWater()) return sum;
  const LocalLight sun = LocalLightAt(seen.hit.point, light);
  const auto add = [&](const glm::dvec3& to_light, const Spectrum& mirrored) {
    const glm::dvec3 across = glm::cross(to_light, to_eye);
    const double sine = glm::length(across);
    if (sine < 1e-9) return;
    const Analyser analyser = AnalyserAlong(across / sine, axes);
    const auto degree = static_cast<float>(Water::Polarisation(glm::dot(to_light, to_eye)));
    sum.q = sum.q + degree * analyser.q * mirrored;
    sum.u = sum.u + degree * analyser.u * mirrored;
  };
  const glm::dvec3 to_disk =
      TowardsDisk(light.source.direction.seen, light.source.radius_rad, disk_sample);
  if (const auto direct = SunIrradiance(seen.hit, from, sun, to_disk)) {
    const double glitter = seen.patch.Glitter(AnglesBetween(seen.hit.normal, to_disk, to_eye));
    add(to_disk, static_cast<float>(glitter) * *direct);
  }
  if (light.effects.Has(Effect::kSkylight) && light.on_terrain) {
    const auto rays = seen.patch.Mirrored(seen.hit.normal, to_eye);
    for (const MirroredRay& ray : rays.All())
      add(ray.direction, static_cast<float>(ray.weight) * SeenIn(ray, seen.hit, from, sun));
  }
  return light.source.irradiance * sum;
}

}  // namespace alpenglow::renderer
