// SPDX-License-Identifier: MIT
#include "renderer/picture/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/illumination/night_light.h"

namespace alpenglow::renderer {

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

namespace {

std::optional<BandLight> SkyglowOf(const Scene& scene, const SceneGround& ground,
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

PreparedScene::PreparedScene(const Scene& scene, std::shared_ptr<const SceneGround> ground,
                             const PreparedScene* other, const Place& pattern_eye)
    : scene_(scene),
      ground_(std::move(ground)),
      medium_(OnOsculatingSphere(scene_.medium, scene_.place.latitude_rad())),
      colour_(medium_.wavelengths_nm),
      lamps_(scene_, *ground_, medium_, colour_),
      media_(scene_, *ground_, medium_),
      geometry_(*ground_, medium_, scene_.terrain.HasFineRelief(), pattern_eye),
      smooth_geometry_(*ground_, medium_, false, pattern_eye),
      horizons_(other ? other->horizons_ : std::make_shared<HorizonsOnDemand>(*ground_, medium_)),
      sunlight_(other ? other->sunlight_ : std::make_shared<RecentSunlight>(*ground_)),
      moonlight_(other ? other->moonlight_ : std::make_shared<RecentSunlight>(*ground_)),
      material_(scene_.ground, ColourDrape::Of(scene_, *ground_), medium_.wavelengths_nm),
      terrain_message_(MessageOf(*ground_, material_)),
      air_(medium_, {*ground_, geometry_, lamps_, *horizons_, material_}),
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

namespace {

// A light below this fraction of the light already present is invisible.
constexpr double kUnseenShare = 1e-4;
// Illuminance of the moonless night sky.
constexpr double kNightSky_lux = 1e-3;

/// Returns the rotation of the moon while the shutter is open: westwards with the stars, less its
/// own motion among them of 13.18 degrees a day (Meeus 1998, Astronomical Algorithms, chapter 47),
/// here taken along the equator.
glm::dvec3 MoonTurn(double open_s, double latitude_rad, const FrameTransform& from_eye) {
  constexpr double kBack_rad_per_s = 13.17640 / kSecondsPerDay * kRadiansPerDegree;
  const glm::dvec3 pole = from_eye.Along({0.0, std::cos(latitude_rad), std::sin(latitude_rad)});
  return -(kEarthRotation_rad_per_s - kBack_rad_per_s) * open_s * pole;
}

}  // namespace

Observer ObserverOf(const PreparedScene& scene, const CameraSample& camera_sample) {
  const SceneGround& ground = scene.ground();
  const Place& place = scene.scene().place;
  const auto pose = camera_sample.middle();
  const FrameTransform from_eye = pose ? FromEyeAt(ground, pose->place) : FromSceneEye(ground);
  if (camera_sample.bodies) return {from_eye, *camera_sample.bodies};
  const Place eye =
      pose ? pose->place : Place{place.latitude_deg, place.longitude_deg, ground.eye_height_m};
  return {from_eye, SkyBodiesAt(eye, camera_sample.instant)};
}

double IlluminanceBy(const PreparedScene& scene, const DistantLight& source, const glm::dvec3& eye,
                     const Lighting& light) {
  const AirOverGround& over_ground = scene.air().whole();
  const LocalLight sun = over_ground.ground_light.LocalLightAt(eye, light.By(source));
  const auto direct = static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const BandLight irradiance =
      direct * over_ground.air.BeamLeft(sun.altitude_m, sun.mu_s_effective) +
      over_ground.air.multiple_scattering().SkyIrradiance(sun.altitude_m, sun.mu_s_for_air);
  return scene.colour().Xyz(InDouble(source.irradiance * irradiance))[1];
}

double Illuminance(const PreparedScene& scene, const glm::dvec3& eye, const Lighting& light) {
  double lux = light.night ? scene.colour().Xyz(InDouble(light.night->OnSurface(1.0)))[1] : 0.0;
  for (const DistantLight& source : light.Lights()) lux += IlluminanceBy(scene, source, eye, light);
  return lux;
}

namespace {

/// Adds the night sky and moonlight to `light` if the sun is dim enough.
void AddNight(const PreparedScene& scene, const Observer& observer, Lighting& light) {
  const Medium& medium = scene.medium();
  const SceneGeometry& geometry = scene.geometry();
  const glm::dvec3& eye = observer.from_eye.origin_m();
  light.moon_colour = MoonColour(*light.moon, medium.wavelengths_nm);
  const double sun_lux = Illuminance(scene, eye, light);
  if (sun_lux > kDaylight_lux) return;
  const DistantLight moonlight =
      MoonlightOf(*light.moon, observer.bodies, light.moon_colour, light.WholeSun());
  const double moon_lux = IlluminanceBy(scene, moonlight, eye, light);
  if (moon_lux > kUnseenShare * (sun_lux + kNightSky_lux)) light.moonlight = moonlight;
  const double depression_rad =
      -std::asin(glm::dot(light.source.direction.for_air, geometry.UpAt(eye)));
  light.shows = sun_lux > kUnseenShare * (moon_lux + kNightSky_lux) ||
                depression_rad < DepressionOfDarkAir(geometry.AltitudeOf(eye), geometry.radius_m(),
                                                     medium.atmosphere_height_m);
  const std::optional<BandLight>& towns = scene.towns();
  const double towns_lux =
      towns ? kPi * scene.colour().Xyz(InDouble(*towns))[1] : 0.0;  // upper bound
  if (kNightSky_lux + towns_lux < kUnseenShare * sun_lux) return;
  light.night = std::make_shared<NightLight>(
      NightSky(observer.bodies.place, observer.bodies.instant).InFrame(observer.from_eye.axes()),
      scene.air().whole().air.single_scattering(), scene.colour(), geometry.UpAt(eye),
      geometry.AltitudeOf(eye), towns);
}

}  // namespace

Lighting LightingAt(const PreparedScene& scene, const Observer& observer) {
  const Medium& medium = scene.medium();
  const BendingAir air = GentleAirOf(medium);
  const SkyBodies& bodies = observer.bodies;
  const glm::dmat3& frame_from_enu = observer.from_eye.axes();
  const SunInSky sun = bodies.ApparentSun(air);
  Lighting light =
      LightingOf(sun, bodies.instant, scene.scene().place, medium, scene.scene().ground.wetness);
  light.source.direction = frame_from_enu * light.source.direction;
  if (!medium.follows_wgs84) return light;  // other planets have other moons
  light.moon = bodies.ApparentMoonDisk(air);
  const EclipsedDisk disk = bodies.Eclipse();
  if (disk.IsCovered()) {
    light = light.EclipsedBy(disk, medium.wavelengths_nm);
    light.moon->direction.seen = ToMoonBefore(sun, bodies);
  }
  light.moon->direction = frame_from_enu * light.moon->direction;
  light.moon->to_sun = frame_from_enu * light.moon->to_sun;
  light.moon_turn =
      MoonTurn(scene.scene().camera.shutter_s, bodies.place.latitude_rad(), observer.from_eye);
  AddNight(scene, observer, light);
  return light;
}

}  // namespace alpenglow::renderer
