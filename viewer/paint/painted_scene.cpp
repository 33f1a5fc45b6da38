// SPDX-License-Identifier: MIT
#include "viewer/paint/painted_scene.h"

#include <algorithm>

#include "atmosphere/ray/bent_view.h"
#include "renderer/media/local_media.h"
#include "viewer/paint/picture_units.h"

namespace alpenglow {
namespace {

// Lamps and fog stand on ground that is there before the first picture; a landing light needs none.
SceneGround LampGroundOf(const Scene& scene) {
  if (!scene.lights.empty() || scene.fog || scene.town_zenith) return LoadGround(scene);
  GeodeticPosition foot = scene.place;
  foot.height_m = 0.0;
  return {LocalFrame(EllipsoidOf(scene.medium), foot), std::nullopt, 0.0, "", true};
}

Medium MediumAt(const Scene& scene) {
  return OnOsculatingSphere(scene.medium, scene.place.latitude_rad);
}

LandSize LandSizeOf(const PaintSizes& sizes) {
  LandSize size;
  size.detail = sizes.land_detail;
  return size;
}

AirView AirViewOf(const Eye& eye, const SunPosition& sun) {
  return {std::max(eye.place.height_m, 0.0), eye.place.latitude_rad, DirectionToSun(sun)};
}

}  // namespace

PaintedScene::PaintedScene(const Scene& scene, const LandSource& land, const PaintedView& first,
                           const PaintSizes& sizes)
    : scene_(scene),
      ellipsoid_(EllipsoidOf(scene.medium)),
      sizes_(sizes),
      has_land_(!land.IsEmpty()),
      lamp_ground_(LampGroundOf(scene)),
      drape_(DrapeOf(scene, lamp_ground_)),
      material_(scene.ground, drape_.colours, scene.medium.wavelengths_nm),
      air_(SolveAir(MediumAt(scene)), sizes.air,
           AirViewOf(first.eye,
                     ApparentSunAt(first.eye.place, first.now, GentleAirOf(MediumAt(scene))))),
      land_(land, LandSizeOf(sizes), ellipsoid_),
      ground_(scene.ground, drape_.colours, {}),
      ground_textures_(air_.air()->diffuse),
      shade_(ellipsoid_) {
  if (scene.fog) {
    fog_.emplace(LocalMedia(scene, lamp_ground_, MediumAt(scene)).Only(false, true), sizes.fog,
                 kFogUnits);
  }
  shade_.SetSize(sizes.shade.size);
  if (drape_.colours) ground_textures_.SetDrape(TexelsOf(drape_));
}

void PaintedScene::Use(const PaintSizes& sizes) {
  sizes_ = sizes;
  if (fog_) fog_->SetSize(sizes.fog);
  air_.SetQuality(sizes.air);
  shade_.SetSize(sizes.shade.size);
  land_.SetDetail(sizes.land_detail);
}

void PaintedScene::TakeHeights() {
  if (heights_version_ == land_.heights_version()) return;
  heights_version_ = land_.heights_version();
  const GroundSampler sampler = land_.Sampler();
  ground_.SetGround(sampler);
  shade_.SetGround(sampler);
}

void PaintedScene::TakeLight() {
  if (std::optional<LightOfVertices> light = ground_.Light()) land_.Relight(std::move(*light));
  if (ground_.sea_mirror().empty()) return;
  glActiveTexture(GL_TEXTURE0 + kUploadUnit);
  ground_textures_.SetSeaMirror(ground_.sea_mirror());
}

void PaintedScene::Update(const PaintedView& view, const SunPosition& sun, double seconds) {
  air_.Follow(AirViewOf(view.eye, sun));
  land_.Update(view.eye.place, LandViewOf(view), seconds);
  TakeHeights();
  if (ground_.Follow(air_.air(), {view.eye.place, sun, view.now})) TakeLight();
  if (sizes_.has_shafts) shade_.Follow(view.eye.place, sun, kShadeUnit);
  if (fog_) fog_->Follow(air_.air(), view.eye, sun);
}

void PaintedScene::Settle(const PaintedView& view, const SunPosition& sun, int samples) {
  air_.Settle(AirViewOf(view.eye, sun));
  land_.Settle(view.eye.place, LandViewOf(view, samples));
  TakeHeights();
  if (ground_.Settle(air_.air(), {view.eye.place, sun, view.now})) {
    TakeLight();
    land_.Settle(view.eye.place, LandViewOf(view, samples));
  }
  if (sizes_.has_shafts) shade_.Settle(view.eye.place, sun, kShadeUnit);
  if (fog_) fog_->Settle(air_.air(), view.eye, sun);
}

std::optional<PhaseKind> PaintedScene::fog_phase() const {
  return scene_.fog ? std::optional(scene_.fog->phase.kind) : std::nullopt;
}

}  // namespace alpenglow
