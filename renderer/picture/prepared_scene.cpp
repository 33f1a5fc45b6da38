// SPDX-License-Identifier: MIT
#include "renderer/picture/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "atmosphere/medium/medium_presets.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/illumination/night_light.h"
#include "renderer/picture/sphere_light.h"

namespace alpenglow::renderer {
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

std::optional<Spectrum> SkyglowOf(const Scene& scene, const SceneGround& ground,
                                  const AirByEffects& air, const BandColour& colour) {
  if (!scene.town_zenith) return std::nullopt;
  const double ground_m = std::max(GroundHeightUnder(ground, scene.place), 0.0);
  return Skyglow(*scene.town_zenith, ground_m, air.whole().air.single_scattering(), colour);
}

std::string MessageOf(const SceneGround& ground, const GroundMaterial& material) {
  if (material.drape() == nullptr || material.drape()->note().empty()) return ground.message;
  return fmt::format("{}{}{}", ground.message, ground.message.empty() ? "" : "; ",
                     material.drape()->note());
}

}  // namespace

RecentSunlight::Made RecentSunlight::At(const glm::dvec3& to_light, double radius_rad) {
  constexpr std::size_t kMost = 2;
  const std::lock_guard lock(asking_);
  for (const Kept& kept : kept_) {
    if (kept.to_light == to_light && kept.radius_rad == radius_rad) return kept.made;
  }
  if (kept_.size() == kMost) kept_.pop_front();
  const Stopwatch watch;
  auto sunlight = std::make_shared<const TerrainSunlight>(ground_, to_light, radius_rad);
  kept_.push_back({to_light, radius_rad, {std::move(sunlight), watch.seconds()}});
  return kept_.back().made;
}

const AirOverGround& AirByEffects::With(EffectSet effects) const {
  const EffectSet parts = effects.And(kParts);
  if (parts == kParts) return whole_;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<AirOverGround>& partial = partial_[parts];
  if (!partial) {
    partial = std::make_unique<AirOverGround>(OnlyWith(whole_.air.medium(), parts), parts_);
  }
  return *partial;
}

PreparedScene::PreparedScene(const Scene& scene, std::shared_ptr<const SceneGround> ground,
                             const PreparedScene* other, const Place& pattern_eye)
    : scene_(scene),
      ground_(std::move(ground)),
      medium_(OnOsculatingSphere(scene_.medium, scene_.place.latitude_rad())),
      colour_(medium_.wavelengths_nm),
      lamps_(scene_, *ground_, medium_, colour_),
      media_(scene_, *ground_, medium_),
      spheres_(SpheresOf(scene_, *ground_)),
      geometry_(*ground_, medium_, scene_.terrain.HasFineRelief(), pattern_eye),
      smooth_geometry_(*ground_, medium_, false, pattern_eye),
      horizons_(other ? other->horizons_ : std::make_shared<HorizonsOnDemand>(*ground_, medium_)),
      sunlight_(other ? other->sunlight_ : std::make_shared<RecentSunlight>(*ground_)),
      moonlight_(other ? other->moonlight_ : std::make_shared<RecentSunlight>(*ground_)),
      clouds_(other ? other->clouds_
                    : std::make_shared<CloudsByTime>(scene_,
                                                     GroundHeightUnder(*ground_, scene_.place),
                                                     medium_.planet_radius_m)),
      material_(scene_.ground, ColourDrape::Of(scene_, *ground_), medium_.wavelengths_nm),
      terrain_message_(MessageOf(*ground_, material_)),
      air_(medium_, {*ground_, geometry_, lamps_, *horizons_, material_, &spheres_}),
      towns_(SkyglowOf(scene_, *ground_, air_, colour_)),
      pattern_origin_(PatternOrigin(pattern_eye)) {}

std::unique_ptr<PreparedScene> PreparedScene::OnOtherBands(int bands) const {
  const std::optional<Medium> other = OnBands(scene_.medium, bands);
  if (!other) return nullptr;
  Scene same = scene_;
  same.medium = *other;
  return std::unique_ptr<PreparedScene>(new PreparedScene(same, ground_, this, pattern_origin_));
}

const PreparedScene& PreparedScene::WithPatternAt(const Place& eye) const {
  const Place origin = PatternOrigin(eye);
  if (origin == pattern_origin_) return *this;
  const std::lock_guard lock(patterns_mutex_);
  for (const auto& other : other_patterns_) {
    if (other->pattern_origin_ == origin) return *other;
  }
  other_patterns_.push_back(
      std::unique_ptr<PreparedScene>(new PreparedScene(scene_, ground_, this, eye)));
  return *other_patterns_.back();
}

const PreparedScene& PreparedScene::OnFewBands() const {
  constexpr int kFew = 4;
  std::call_once(few_bands_asked_, [&] {
    if (medium_.wavelengths_nm.size() > kFew) few_bands_ = OnOtherBands(kFew);
  });
  return few_bands_ ? *few_bands_ : *this;
}

}  // namespace alpenglow::renderer
