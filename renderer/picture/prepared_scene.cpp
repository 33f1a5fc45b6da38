// SPDX-License-Identifier: MIT
#include "renderer/picture/prepared_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/astronomy/eclipse.h"
#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/night_light.h"
#include "renderer/surface/scene_geometry.h"

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

// A light below this fraction of the light already present is invisible.
constexpr double kUnseenShare = 1e-4;
// Illuminance of the moonless night sky.
constexpr double kNightSky_lux = 1e-3;

/// Returns the rotation of the moon while the shutter is open: westwards with the stars, less its
/// own motion among them of 13.18 degrees a day (Meeus 1998, Astronomical Algorithms, chapter 47),
/// here taken along the equator.
glm::dvec3 MoonTurn(double open_s, double latitude_rad, const CameraStand& stand) {
  constexpr double kBack_rad_per_s = 13.17640 / 86400.0 * kRadiansPerDegree;
  const glm::dvec3 pole =
      stand.frame_from_enu * glm::dvec3(0.0, std::cos(latitude_rad), std::sin(latitude_rad));
  return -(kEarthRotation_rad_per_s - kBack_rad_per_s) * open_s * pole;
}

}  // namespace

double PreparedScene::IlluminanceBy(const DistantLight& source, const glm::dvec3& eye,
                                    const Lighting& light) const {
  const LocalSun sun = models.whole().ground_light.LocalSunAt(eye, light.By(source));
  const auto direct = static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const BandLight irradiance =
      direct * models.whole().sunlit().BeamLeft(sun.altitude_m, sun.mu_s_effective) +
      models.whole().multiple_scattering.SkyIrradiance(sun.altitude_m, sun.mu_s_for_air);
  return colour.Xyz(InDouble(source.irradiance * irradiance))[1];
}

double PreparedScene::SunIlluminance(const FrameContext& frame) const {
  return IlluminanceBy(frame.light.Sun(), frame.camera().eye(), frame.light);
}

double PreparedScene::Illuminance(const glm::dvec3& eye, const Lighting& light) const {
  double lux = light.night ? colour.Xyz(InDouble(light.night->OnSurface(1.0)))[1] : 0.0;
  for (const DistantLight& source : light.Lights()) lux += IlluminanceBy(source, eye, light);
  return lux;
}

LampPlan PreparedScene::PlanLamps(const FrameContext& frame) const {
  // A lamp is negligible if all neglected lamps together change a grey card in daylight by less
  // than a thousandth.
  constexpr double kGreyCard = 0.18;
  LampSettings lamp_settings = frame.settings.lamps;
  lamp_settings.floor_cd_per_m2 =
      std::max(lamp_settings.floor_cd_per_m2,
               1e-3 * kGreyCard / kPi * Illuminance(frame.camera().eye(), frame.light));
  return frame.lamps->PlanFor(
      frame.moving, frame.settings.width, frame.settings.height, lamp_settings,
      [&](const CameraRay& ray) {
        return geometry.Trace(ray.origin, ray.direction, frame.camera().PixelAngle()).distance_m;
      });
}

GeodeticPosition PreparedScene::EyeOf(const CameraSample& camera_sample) const {
  if (const auto pose = camera_sample.middle()) return pose->place;
  return {scene.place.latitude_rad, scene.place.longitude_rad, ground.eye_height_m};
}

SunPosition PreparedScene::ApparentSun(const CameraSample& camera_sample) const {
  return ApparentSunAt(EyeOf(camera_sample), camera_sample.instant, GentleAirOf(medium));
}

CameraStand PreparedScene::StandOf(const CameraSample& camera_sample) const {
  const auto pose = camera_sample.middle();
  return pose ? StandAt(ground, pose->place) : StandOfScene(ground);
}

Lighting PreparedScene::LightingAt(const CameraSample& camera_sample,
                                   const CameraStand& stand) const {
  const SunPosition sun = ApparentSun(camera_sample);
  Lighting light =
      LightingOf(sun, camera_sample.instant, scene.place, medium, scene.ground.wetness);
  light.to_sun = stand.frame_from_enu * light.to_sun;
  light.to_sun_for_air = stand.frame_from_enu * light.to_sun_for_air;
  if (!medium.follows_wgs84) return light;  // other planets have other moons
  const GeodeticPosition eye = EyeOf(camera_sample);
  light.moon = ApparentMoonDisk(eye, camera_sample.instant, sun.distance_au, GentleAirOf(medium));
  const EclipsedDisk disk = EclipsedDiskOf(sun, MoonAt(eye, camera_sample.instant));
  if (disk.IsCovered()) {
    light = light.EclipsedBy(disk, medium.wavelengths_nm);
    light.moon->to_moon = ToMoonBefore(sun, eye, camera_sample.instant);
  }
  light.moon->to_moon = stand.frame_from_enu * light.moon->to_moon;
  light.moon->to_moon_for_air = stand.frame_from_enu * light.moon->to_moon_for_air;
  light.moon->to_sun = stand.frame_from_enu * light.moon->to_sun;
  light.moon_turn = MoonTurn(scene.camera.shutter_s, eye.latitude_rad, stand);
  AddNight(camera_sample, stand, sun.distance_au, light);
  return light;
}

std::optional<BandLight> PreparedScene::SkyglowOf() const {
  if (!scene.town_zenith) return std::nullopt;
  const double ground_m = std::max(GroundHeightUnder(ground, scene.place), 0.0);
  return Skyglow(*scene.town_zenith, ground_m, models.whole().air, colour);
}

void PreparedScene::AddNight(const CameraSample& camera_sample, const CameraStand& stand,
                             double earth_sun_au, Lighting& light) const {
  light.moon_colour = MoonColour(*light.moon, medium.wavelengths_nm);
  const double sun_lux = Illuminance(stand.eye, light);
  if (sun_lux > kDaylight_lux) return;
  const GeodeticPosition eye = EyeOf(camera_sample);
  const DistantLight moonlight = MoonlightOf(*light.moon, eye, camera_sample.instant, earth_sun_au,
                                             light.moon_colour, light.WholeSun());
  const double moon_lux = IlluminanceBy(moonlight, stand.eye, light);
  if (moon_lux > kUnseenShare * (sun_lux + kNightSky_lux)) light.moonlight = moonlight;
  const double depression_rad =
      -std::asin(glm::dot(light.to_sun_for_air, geometry.UpAt(stand.eye)));
  light.shows =
      sun_lux > kUnseenShare * (moon_lux + kNightSky_lux) ||
      depression_rad < DepressionOfDarkAir(geometry.AltitudeOf(stand.eye), geometry.radius_m(),
                                           medium.atmosphere_height_m);
  const double towns_lux = towns ? kPi * colour.Xyz(InDouble(*towns))[1] : 0.0;  // upper bound
  if (kNightSky_lux + towns_lux < kUnseenShare * sun_lux) return;
  light.night = std::make_shared<NightLight>(
      NightSky(eye, camera_sample.instant).InFrame(stand.frame_from_enu), models.whole().air,
      colour, geometry.UpAt(stand.eye), geometry.AltitudeOf(stand.eye), towns);
}

FrameContext PreparedScene::FrameAt(const CameraSample& camera_sample,
                                    const RenderSettings& settings) const {
  const MovingCamera camera =
      CameraOn(ground, scene.camera, camera_sample.poses, settings.width, settings.height);
  FrameContext frame{settings,
                     &models.With(settings.effects),
                     camera,
                     PixelFilter(settings.filter),
                     LightingAt(camera_sample, StandOf(camera_sample)),
                     std::make_shared<TerrainSunlight>(),
                     std::make_shared<LampLight>(lamps.SeenBy(camera.middle())),
                     std::make_shared<LampPlan>(),
                     nullptr};
  frame.light.effects = settings.effects;
  frame.polarised = camera.middle().HasPolariser() ||
                    std::any_of(settings.layers.begin(), settings.layers.end(), IsOfPolarisation);
  if (frame.Has(Effect::kRefraction)) frame.bent = RefractedViewRaysOf(frame, camera_sample);
  if (frame.Has(Effect::kShafts) && frame.light.shows) {
    Prepare(settings.progress, "shadows");
    const auto made = recent_sunlight->At(frame.light.to_sun, frame.light.sun_radius_rad);
    frame.sunlight = made.sunlight;
    frame.sunlight_s = made.made_in_s;
  }
  if (frame.Has(Effect::kLights)) {
    if (!lamps.All().empty()) Prepare(settings.progress, "lamps");
    const Stopwatch watch;
    frame.plan = std::make_shared<LampPlan>(PlanLamps(frame));
    frame.plan_s = watch.seconds();
  }
  LightNight(frame);
  LightMedia(frame);
  LightTerrain(frame);
  if (frame.Has(Effect::kStars)) frame.stars = StarsIn(frame, camera_sample);
  return frame;
}

void PreparedScene::LightNight(FrameContext& frame) const {
  frame.night = nullptr;
  frame.moonlit = nullptr;
  if (frame.Has(Effect::kNightSky)) frame.night = frame.light.night;
  if (!frame.Has(Effect::kMoonlight) || !frame.light.moonlight) return;
  SecondLight moon{frame.light.By(*frame.light.moonlight), BandLight(frame.light.irradiance.count),
                   std::make_shared<TerrainSunlight>(), nullptr};
  for (std::size_t band = 0; band < moon.by_sun.count; ++band)
    moon.by_sun[band] = moon.light.irradiance[band] / frame.light.irradiance[band];
  if (frame.Has(Effect::kShafts))
    moon.sunlight = recent_moonlight->At(moon.light.to_sun, moon.light.sun_radius_rad).sunlight;
  frame.moonlit = std::make_shared<SecondLight>(std::move(moon));
}

std::optional<BandLight> PreparedScene::LeftOfSpace(const FrameContext& frame, double x,
                                                    double y) const {
  const CameraRay ray = frame.camera().MiddleRay(x, y);
  const Hit hit = Trace(ray, frame);
  if (hit.kind != HitKind::kSky) return std::nullopt;
  SharedSegmentAir air{hit.kind, hit.distance_m, ray.through, ray.through, hit.distance_m, 1};
  AddAir(frame, geometry, medium, air);
  const BandLight fog =
      frame.lamps->FogTransmittance(ray.through, frame.HasLitFog() ? 0.0 : air.length_m());
  const BandLight left = fog * air.air.transmittance;
  return frame.camera().HasPolariser() ? 0.5F * left : left;
}

std::shared_ptr<const StarPixels> PreparedScene::StarsIn(const FrameContext& frame,
                                                         const CameraSample& camera_sample) const {
  const double lux = Illuminance(frame.camera().eye(), frame.light);
  if (!frame.light.moon || lux > kDaylight_lux) return nullptr;
  const MoonDisk& moon = *frame.light.moon;
  const glm::dmat3 frame_from_enu = StandOf(camera_sample).frame_from_enu;
  std::vector<StarLight> lights;
  const double pixel_rad = frame.camera().PixelAngle();
  const RefractedView view(medium, geometry.AltitudeOf(frame.camera().eye()));
  for (StarLight& light :
       StarLightsOver(EyeOf(camera_sample), camera_sample.instant, view, colour,
                      FaintestStar(lux, pixel_rad), OpenFor(scene.camera.shutter_s, pixel_rad))) {
    light.direction = frame_from_enu * light.direction;
    for (glm::dvec3& direction : light.way) direction = frame_from_enu * direction;
    if (glm::length(light.direction - moon.to_moon) >= moon.radius_rad)
      lights.push_back(std::move(light));
  }
  if (lights.empty()) return nullptr;
  return std::make_shared<StarPixels>(
      frame.camera(), frame.settings.width, frame.settings.height, lights,
      [&](double x, double y) { return LeftOfSpace(frame, x, y); },
      [&](double x, double y) {
        return Trace(frame.camera().MiddleRay(x, y), frame).kind != HitKind::kSky;
      });
}

// Computes the terrain's illumination by the sun and by the moon.
void PreparedScene::LightTerrain(FrameContext& frame) const {
  Prepare(frame.settings.progress, "light of slopes");
  if (frame.Has(Effect::kHorizons)) (void)horizons->Get();  // computed once, for all frames
  const Stopwatch watch;
  if (frame.light.shows)
    frame.light.on_terrain = frame.model->ground_light.OnTerrain(frame.ground_sources());
  if (frame.moonlit) {
    SecondLight moon = *frame.moonlit;
    moon.light.on_terrain = frame.model->ground_light.OnTerrain(moon.ground_sources());
    frame.moonlit = std::make_shared<SecondLight>(std::move(moon));
  }
  frame.slopes_s = watch.seconds();
}

void PreparedScene::LightMedia(FrameContext& frame) const {
  // Below a millionth of a lux of sunlight, only lamps light fog, unless fog stands in front of a
  // volume.
  const bool has_volumes = frame.Has(Effect::kVolumes) && media.HasVolumes();
  const bool is_lit =
      frame.Has(Effect::kFogGlow) && (has_volumes || frame.moonlit || SunIlluminance(frame) > 1e-6);
  LocalMedia here = media.Only(has_volumes, is_lit);
  frame.media = here.IsNothing()
                    ? nullptr
                    : std::make_shared<MediaLight>(
                          std::move(here), geometry, frame.model->sunlit(), frame.light,
                          frame.Has(Effect::kLights) ? frame.lamps.get() : nullptr);
  if (frame.moonlit) {
    SecondLight moon = *frame.moonlit;
    moon.media = frame.media
                     ? std::make_shared<MediaLight>(frame.media->media().WithoutGlow(), geometry,
                                                    frame.model->sunlit(), moon.light)
                     : nullptr;
    frame.moonlit = std::make_shared<SecondLight>(std::move(moon));
  }
}

// Returns the frame with fewer effects.
FrameContext PreparedScene::Reduced(FrameContext frame, EffectSet effects) const {
  constexpr EffectSet kThatLightTerrain{Effect::kHorizons,  Effect::kBounce,  Effect::kSkylight,
                                        Effect::kShadows,   Effect::kFogGlow, Effect::kVolumes,
                                        Effect::kMolecules, Effect::kAerosol, Effect::kOzone};
  const bool is_lit_alike =
      frame.settings.effects.And(kThatLightTerrain) == effects.And(kThatLightTerrain);
  constexpr EffectSet kThatLightMedia{Effect::kFogGlow,   Effect::kVolumes, Effect::kLights,
                                      Effect::kMolecules, Effect::kAerosol, Effect::kOzone};
  const bool media_are_lit_alike =
      frame.settings.effects.And(kThatLightMedia) == effects.And(kThatLightMedia);
  frame.settings.effects = frame.light.effects = effects;
  frame.model = &models.With(effects);
  if (!effects.Has(Effect::kShafts)) frame.sunlight = std::make_shared<TerrainSunlight>();
  if (!effects.Has(Effect::kNightSky)) frame.night = nullptr;
  if (!effects.Has(Effect::kStars)) frame.stars = nullptr;
  if (!effects.Has(Effect::kRefraction)) frame.bent = nullptr;
  if (frame.moonlit) {
    SecondLight moon = *frame.moonlit;
    moon.light.effects = effects;
    if (!effects.Has(Effect::kShafts)) moon.sunlight = std::make_shared<TerrainSunlight>();
    frame.moonlit =
        effects.Has(Effect::kMoonlight) ? std::make_shared<SecondLight>(std::move(moon)) : nullptr;
  }
  if (!effects.Has(Effect::kLights)) frame.plan = std::make_shared<LampPlan>();
  if (!media_are_lit_alike) LightMedia(frame);
  if (!is_lit_alike) LightTerrain(frame);
  return frame;
}

}  // namespace alpenglow::renderer
