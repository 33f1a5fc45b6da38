// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_shader.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/illumination/polarised_axes.h"
#include "renderer/lit_ground/ground_light.h"
#include "renderer/picture/disk_radiance.h"
#include "renderer/picture/refracted_view_rays.h"

namespace alpenglow::renderer {
namespace {

/// Applies the camera's polariser.
Shaded Polarised(const CameraRays& camera, const glm::dvec3& direction,
                 const PolarisedLight& inscatter, Shaded shaded) {
  const std::optional<glm::dvec3> passed = camera.PassedBy(direction);
  if (!passed) return shaded;
  const Analyser analyser = AnalyserAlong(*passed, camera.AxesAt(direction));
  shaded.radiance = Passed(analyser, shaded.radiance, &*shaded.polarised);
  shaded.inscatter = Passed(analyser, shaded.inscatter, &inscatter);
  shaded.lamps = Passed(analyser, shaded.lamps, nullptr);
  shaded.volumes = Passed(analyser, shaded.volumes, nullptr);
  shaded.clouds = Passed(analyser, shaded.clouds, nullptr);
  shaded.polarised = {analyser.q * shaded.radiance, analyser.u * shaded.radiance};
  return shaded;
}

/// Returns the hit of a sphere that is in front of another hit; else that one.
Hit OrOnSphere(const std::vector<SpecularSphere>& spheres, const CameraRay& ray, const Hit& hit,
               double pixel_rad) {
  const std::optional<EnteredSphere> entered = FirstSphereOn(spheres, ray.origin, ray.direction);
  if (!entered || entered->distance_m >= hit.distance_m) return hit;
  const glm::dvec3 point = ray.origin + entered->distance_m * ray.direction;
  const glm::dvec3 normal = glm::normalize(point - spheres[entered->number].centre);
  return {HitKind::kSphere,
          entered->distance_m,
          normal,
          normal,
          normal,
          point,
          point,
          entered->distance_m * pixel_rad};
}

/// Returns the light of towns that clouds send to a surface [W m^-2 nm^-1]: the ground around emits the
/// radiance 2 J (Skyglow).
/// @param cos_up  between its normal and the vertical.
Spectrum TownsByClouds(const FrameContext& frame, const glm::dvec3& point, double cos_up) {
  const std::optional<Spectrum>& towns = frame.scene().towns();
  const LitClouds* clouds = frame.lights().front().clouds.get();
  const Spectrum none(frame.scene().medium().wavelengths_nm.size());
  if (!towns || clouds == nullptr || !frame.Has(Effect::kCloudGlow)) return none;
  return static_cast<float>(kPi * (1.0 + cos_up)) *
         (*towns * clouds->SentBackAt(frame.geometry().AltitudeOf(point)));
}

}  // namespace

Hit PixelShader::Trace(const CameraRay& ray, double expected_m) const {
  const RefractedViewRays* bent = frame_->bent();
  const Hit hit =
      bent && bent->moves_ground
          ? OnRefractedRay(*frame_, ray, expected_m)
          : frame_->geometry().Trace(ray.origin, ray.direction, frame_->camera().PixelAngle());
  return OrOnSphere(frame_->scene().spheres(), ray, hit, frame_->camera().PixelAngle());
}

std::optional<Spectrum> PixelShader::LeftOfSpace(double x, double y) const {
  const CameraRay ray = frame_->camera().MiddleRay(x, y);
  const Hit hit = Trace(ray);
  if (hit.kind != HitKind::kSky) return std::nullopt;
  SharedSegmentAir air = SharedSegmentAir::Of(hit, ray.through, *frame_);
  AddAir(*frame_, air);
  const Spectrum left =
      air.clouds.DiskLeft() * (UnmarchedLayers(*frame_, ray.through, air.length_m()) *
                               (air.narrow_left * air.air.transmittance));
  return frame_->camera().HasPolariser() ? 0.5F * left : left;
}

Spectrum PixelShader::SunFrom(const glm::dvec3& direction) const {
  return DiskFrom(direction, SunDiskRadiance);
}

Spectrum PixelShader::MoonFrom(const glm::dvec3& direction) const {
  return DiskFrom(direction, MoonDiskRadiance);
}

Spectrum PixelShader::DiskFrom(const glm::dvec3& direction, DiskBehind disk) const {
  const Spectrum none(frame_->scene().medium().wavelengths_nm.size());
  AirAlongRay clear{none, none};
  std::ranges::fill(clear.transmittance.values(), 1.0F);
  const Spectrum bare = disk(*frame_, direction, clear);
  if (std::all_of(bare.values().begin(), bare.values().end(),
                  [](float band) { return band <= 0.0F; }))
    return none;
  SharedSegmentAir air = SharedSegmentAir::Of(Hit{}, direction, *frame_);
  AddAir(*frame_, air);
  const Spectrum left = UnmarchedLayers(*frame_, direction, air.length_m()) * bare;
  const float polarised = frame_->camera().HasPolariser() ? 0.5F : 1.0F;
  return polarised * air.clouds.DiskLeft() * (air.narrow_left * (air.air.transmittance * left));
}

PolarisedLight PixelShader::PolarisedGround(const Hit& hit, const CameraRay& ray,
                                            std::array<double, 2> disk_sample) const {
  const GroundLight& ground_light = frame_->over_ground().ground_light;
  const ViewAxes axes = frame_->camera().AxesAt(ray.through);
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame_->light());
  std::optional<PolarisedLight> sum;
  for (const FrameLight& source : frame_->lights()) {
    if (!source.light.shows) continue;
    const PolarisedLight sent =
        ground_light.Polarised(seen, source.ground_sources(), axes, disk_sample);
    sum = sum ? *sum + sent : sent;
  }
  const std::size_t bands = frame_->scene().medium().wavelengths_nm.size();
  return sum.value_or(PolarisedLight{Spectrum(bands), Spectrum(bands)});
}

Shaded PixelShader::Shade(const Hit& hit, const SharedSegmentAir& through, const CameraRay& ray,
                          const LampTile& near, std::array<double, 2> disk_sample,
                          const Spectrum* traced) const {
  Shaded shaded = WithoutPolariser(hit, through, ray, near, disk_sample, traced, 0);
  if (!frame_->IsPolarised()) return shaded;
  const PolarisedLight inscatter =
      (through.layers_left * frame_->light().source.irradiance) * *through.air.polarised;
  shaded.polarised = inscatter;
  if (hit.kind != HitKind::kSky && hit.kind != HitKind::kSphere) {
    shaded.polarised = inscatter + shaded.transmittance * PolarisedGround(hit, ray, disk_sample);
  }
  return Polarised(frame_->camera(), ray.through, inscatter, std::move(shaded));
}

Shaded PixelShader::WithoutPolariser(const Hit& hit, const SharedSegmentAir& through,
                                     const CameraRay& ray, const LampTile& near,
                                     std::array<double, 2> disk_sample, const Spectrum* traced,
                                     int spheres) const {
  const FrameContext& frame = *frame_;
  const NightLight* night = frame.sky_lights().night.get();
  Shaded shaded;
  shaded.inscatter =
      through.layers_left * (frame_->light().source.irradiance * through.air.inscatter) +
      through.night;
  shaded.transmittance = through.layers_left * through.air.transmittance;
  shaded.albedo = Spectrum(frame.scene().medium().wavelengths_nm.size());
  const auto left = [&](double distance_m) {
    return through.clouds.TransmittanceTo(distance_m) *
           LeftByBodies(through.pieces, distance_m, through.media.size());
  };
  shaded.lamps =
      through.lamp_light + frame.lamps().Seen(near.seen, ray, frame_->camera().PixelAngle(), left);
  shaded.volumes = through.media + CausticsAlong(ray, hit.distance_m);
  shaded.clouds = through.layers_left * through.cloud_light;
  shaded.cloud_transmittance = through.clouds.transmittance();
  shaded.cloud_distance_m = through.clouds.WeightedDistance_m();
  shaded.radiance = traced != nullptr
                        ? *traced
                        : shaded.inscatter + shaded.lamps + shaded.volumes + shaded.clouds;
  if (hit.kind == HitKind::kSky) {
    const Spectrum disk_left =
        through.clouds.DiskLeft() * (through.narrow_left * through.layers_left);
    if (!frame.sky_lights().small_sun)
      shaded.radiance =
          shaded.radiance + disk_left * SunDiskRadiance(frame, ray.direction, through.air);
    if (!frame.sky_lights().small_moon)
      shaded.radiance =
          shaded.radiance + disk_left * MoonDiskRadiance(frame, ray.direction, through.air);
    if (night)
      shaded.radiance = shaded.radiance + shaded.transmittance * night->Above(ray.direction);
  } else if (hit.kind == HitKind::kSphere) {
    AddSphere(ray, near, disk_sample, spheres, shaded);
  } else {
    AddGround(hit, ray, near, disk_sample, traced == nullptr, shaded);
  }
  return shaded;
}

Spectrum PixelShader::CausticsAlong(const CameraRay& ray, double length_m) const {
  Spectrum light(frame_->scene().medium().wavelengths_nm.size());
  for (const FrameLight& source : frame_->lights()) {
    if (source.caustics)
      light = light + source.caustics->Along(ray.origin, ray.direction, length_m);
  }
  return light;
}

void PixelShader::AddSphere(const CameraRay& ray, const LampTile& near,
                            std::array<double, 2> disk_sample, int spheres, Shaded& shaded) const {
  // Weaker orders, and light that has met more spheres, are left out.
  constexpr double kLeastShare = 2e-3;
  constexpr int kMostOrder = 3, kMostSpheres = 4;
  const FrameContext& frame = *frame_;
  const std::vector<SpecularSphere>& all = frame.scene().spheres();
  const std::optional<EnteredSphere> entered = FirstSphereOn(all, ray.origin, ray.direction);
  if (!entered || spheres >= kMostSpheres) return;
  const DividedRay divided(all[entered->number], ray.origin + entered->distance_m * ray.direction,
                           ray.direction);
  for (int order = 0; order <= kMostOrder; ++order) {
    const double share = divided.Share(order);
    if (share < kLeastShare) continue;
    const LeavingRay leaving = divided.Leaving(order);
    const CameraRay next{leaving.origin, leaving.origin, leaving.direction, leaving.direction};
    const Hit behind = OrOnSphere(
        all, next, frame.geometry().Trace(next.origin, next.direction, frame.camera().PixelAngle()),
        frame.camera().PixelAngle());
    SharedSegmentAir air = SharedSegmentAir::Of(behind, next.direction, frame);
    AddAir(frame, air);
    air.layers_left = UnmarchedLayers(frame, next.direction, air.length_m());
    air.lamp_light = air.night = Spectrum(air.media.size());
    const Shaded seen =
        WithoutPolariser(behind, air, next, near, disk_sample, nullptr, spheres + 1);
    shaded.radiance =
        shaded.radiance + static_cast<float>(share) * (shaded.transmittance * seen.radiance);
  }
}

Spectrum PixelShader::OnePath(const CameraRay& ray,
                              atmosphere::reference::PathRandom& random) const {
  Spectrum light(frame_->scene().medium().wavelengths_nm.size());
  for (const FrameLight& source : frame_->lights()) {
    if (!source.paths) continue;
    const SpectrumOf<double> path = source.paths->OnePath(ray.origin, ray.direction, random);
    for (std::size_t band = 0; band < light.size(); ++band)
      light[band] += static_cast<float>(path[band]) * source.light.source.irradiance[band];
  }
  return light;
}

void PixelShader::AddGround(const Hit& hit, const CameraRay& ray, const LampTile& near,
                            std::array<double, 2> disk_sample, bool has_natural,
                            Shaded& shaded) const {
  const GroundLight& ground_light = frame_->over_ground().ground_light;
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame_->light());
  shaded.albedo = seen.albedo;
  Spectrum natural(shaded.albedo.size());
  for (const FrameLight& source : frame_->lights()) {
    if (!source.light.shows) continue;
    const NaturalRadiance sent = ground_light.Natural(seen, source.ground_sources(), disk_sample);
    if (&source == &frame_->lights().front()) shaded.sun_visibility = sent.disk_visibility;
    if (!has_natural) continue;
    natural = natural + sent.radiance;
    // Light through spheres takes the place of their shadows.
    if (source.caustics && source.light.effects.Has(Effect::kShadows))
      natural = natural + static_cast<float>(1.0 / kPi) *
                              (seen.albedo * source.caustics->OnGround(hit.smooth_point));
  }
  if (const NightLight* night = frame_->sky_lights().night.get()) {
    const double cos_up = glm::dot(hit.normal, seen.up);
    const Spectrum light = night->OnSurface(cos_up) + TownsByClouds(*frame_, hit.point, cos_up);
    natural = natural + static_cast<float>(1.0 / kPi) * (seen.albedo * light);
  }
  const Spectrum lamp_light = shaded.transmittance * ground_light.OfLamps(seen, near.surface);
  shaded.lamps = shaded.lamps + lamp_light;
  if (const MediaLight* media = frame_->media()) {
    const Spectrum glow = shaded.transmittance * ground_light.OfGlow(seen, *media);
    shaded.volumes = shaded.volumes + glow;
    shaded.radiance = shaded.radiance + glow;
  }
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * natural;
}

}  // namespace alpenglow::renderer
