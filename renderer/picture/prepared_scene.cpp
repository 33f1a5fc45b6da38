// SPDX-License-Identifier: MIT
#include "renderer/picture/prepared_scene.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "atmosphere/medium/medium_presets.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/illumination/night_light.h"

namespace alpenglow::renderer {

RecentSunlight::Made RecentSunlight::At(const glm::dvec3& to_sun, double sun_radius_rad) {
  constexpr std::size_t kMost = 2;
  const std::lock_guard lock(asking_);
  for (const Kept& kept : kept_) {
    if (kept.to_sun == to_sun && kept.sun_radius_rad == sun_radius_rad) return kept.made;
  }
  if (kept_.size() == kMost) kept_.pop_front();
  const Stopwatch watch;
  auto sunlight = std::make_shared<const TerrainSunlight>(ground_, to_sun, sun_radius_rad);
  kept_.push_back({to_sun, sun_radius_rad, {std::move(sunlight), watch.seconds()}});
  return kept_.back().made;
}

namespace {

constexpr EffectSet kParts{Effect::kMolecules, Effect::kAerosol, Effect::kOzone};

Medium OnlyWith(Medium medium, EffectSet parts) {
  const std::vector<double> none(medium.wavelengths_nm.size(), 0.0);
  if (!parts.Has(Effect::kMolecules)) medium.rayleigh_scattering_per_m = none;
  if (!parts.Has(Effect::kAerosol))
    medium.mie_scattering_per_m = medium.mie_extinction_per_m = none;
  if (!parts.Has(Effect::kOzone)) medium.ozone_absorption_per_m = none;
  return medium;
}

}  // namespace

const AirModel& AirModels::With(EffectSet effects) const {
  const EffectSet parts = effects.And(kParts);
  if (parts == kParts) return whole_;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<AirModel>& partial = partial_[parts];
  if (!partial) {
    partial = std::make_unique<AirModel>(OnlyWith(whole_.air.medium(), parts), parts_);
  }
  return *partial;
}

namespace {

std::optional<BandLight> SkyglowOf(const Scene& scene, const SceneGround& ground,
                                   const AirModels& models, const BandColour& colour) {
  if (!scene.town_zenith) return std::nullopt;
  const double ground_m = std::max(GroundHeightUnder(ground, scene.place), 0.0);
  return Skyglow(*scene.town_zenith, ground_m, models.whole().air, colour);
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene, std::shared_ptr<const SceneGround> ground,
                             const PreparedScene* other)
    : scene_(scene),
      ground_(std::move(ground)),
      medium_(OnOsculatingSphere(scene_.medium, scene_.place.latitude_rad)),
      colour_(medium_.wavelengths_nm),
      lamps_(scene_, *ground_, medium_, colour_),
      media_(scene_, *ground_, medium_),
      geometry_(*ground_, medium_, scene_.terrain.HasFineRelief()),
      smooth_geometry_(*ground_, medium_, false),
      horizons_(other ? other->horizons_ : std::make_shared<HorizonsOnDemand>(*ground_, medium_)),
      sunlight_(other ? other->sunlight_ : std::make_shared<RecentSunlight>(*ground_)),
      moonlight_(other ? other->moonlight_ : std::make_shared<RecentSunlight>(*ground_)),
      material_(scene_.ground, ColourDrape::Of(scene_, *ground_), medium_.wavelengths_nm),
      models_(medium_, {*ground_, geometry_, lamps_, *horizons_, material_}),
      towns_(SkyglowOf(scene_, *ground_, models_, colour_)) {}

std::unique_ptr<PreparedScene> PreparedScene::OnOtherBands(int bands) const {
  const std::optional<Medium> other = OnBands(scene_.medium, bands);
  if (!other) return nullptr;
  Scene same = scene_;
  same.medium = *other;
  return std::unique_ptr<PreparedScene>(new PreparedScene(same, ground_, this));
}

const PreparedScene& PreparedScene::OnFewBands() const {
  constexpr int kFew = 4;
  std::call_once(few_bands_asked_, [&] {
    if (medium_.wavelengths_nm.size() > kFew) few_bands_ = OnOtherBands(kFew);
  });
  return few_bands_ ? *few_bands_ : *this;
}

}  // namespace alpenglow::renderer
