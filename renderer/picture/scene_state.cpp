// SPDX-License-Identifier: MIT
#include "renderer/picture/scene_state.h"

#include <algorithm>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/sun.h"
#include "lut/program/program.h"
#include "renderer/ground/terrain_sunlight.h"

namespace alpenglow {

double SceneState::Illuminance(const glm::dvec3& eye, const Lighting& light) const {
  const LocalSun sun = models.whole().ground_light.LocalSunAt(eye, light);
  const auto direct = static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const BandLight irradiance =
      direct * models.whole().air.TransmittanceToSpace(sun.altitude_m, sun.mu_s_effective) +
      models.whole().diffuse.SkyIrradiance(sun.altitude_m, sun.mu_s);
  return colour.Xyz(InDouble(light.irradiance * irradiance))[1];
}

LampPlan SceneState::PlanLamps(const PictureFrame& frame) const {
  // Lamps are too dim to see where all that are left out together change a grey card in daylight
  // by less than a thousandth.
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

GeodeticPosition SceneState::EyeOf(const Shot& shot) const {
  if (const auto pose = shot.middle()) return pose->place;
  return {scene.place.latitude_rad, scene.place.longitude_rad, ground.eye_height_m};
}

SunPosition SceneState::ApparentSun(const Shot& shot) const {
  return ApparentSunAt(EyeOf(shot), shot.instant);
}

CameraStand SceneState::StandOf(const Shot& shot) const {
  const auto pose = shot.middle();
  return pose ? StandAt(ground, pose->place) : StandOfScene(ground);
}

Lighting SceneState::LightingAt(const Shot& shot, const CameraStand& stand) const {
  const SunPosition sun = ApparentSun(shot);
  Lighting light = LightingOf(sun, shot.instant, scene.place, medium, scene.ground.wetness);
  light.to_sun = stand.frame_from_enu * light.to_sun;
  if (!medium.follows_wgs84) return light;  // no other planet has this moon
  light.moon = ApparentMoonDisk(EyeOf(shot), shot.instant, sun.distance_au);
  light.moon->to_moon = stand.frame_from_enu * light.moon->to_moon;
  light.moon->to_sun = stand.frame_from_enu * light.moon->to_sun;
  return light;
}

PictureFrame SceneState::FrameAt(const Shot& shot, const RenderSettings& settings,
                                 const std::shared_ptr<const TerrainSunlight>& known) const {
  const MovingCamera camera =
      CameraOn(ground, scene.camera, shot.poses, settings.width, settings.height);
  PictureFrame frame{settings,
                     &models.With(settings.effects),
                     camera,
                     PixelFilter(settings.filter),
                     LightingAt(shot, StandOf(shot)),
                     std::make_shared<TerrainSunlight>(),
                     std::make_shared<LampLight>(lamps.SeenBy(camera.middle())),
                     std::make_shared<LampPlan>(),
                     nullptr};
  frame.light.effects = settings.effects;
  if (frame.Has(Effect::kShafts)) {
    Prepare(settings.progress, "shadows");
    const Stopwatch watch;
    frame.sunlight = known ? known
                           : std::make_shared<TerrainSunlight>(ground, frame.light.to_sun,
                                                               frame.light.sun_radius_rad);
    frame.sunlight_s = watch.seconds();
  }
  if (frame.Has(Effect::kLights)) {
    if (!lamps.All().empty()) Prepare(settings.progress, "lamps");
    const Stopwatch watch;
    frame.plan = std::make_shared<LampPlan>(PlanLamps(frame));
    frame.plan_s = watch.seconds();
  }
  LightMedia(frame);
  LightTerrain(frame);
  return frame;
}

void SceneState::LightTerrain(PictureFrame& frame) const {
  Prepare(frame.settings.progress, "light of slopes");
  if (frame.Has(Effect::kHorizons)) (void)horizons->Get();  // made once, for all frames
  const Stopwatch watch;
  frame.light.on_terrain = frame.model->ground_light.OnTerrain(frame.ground_sources());
  frame.slopes_s = watch.seconds();
}

void SceneState::LightMedia(PictureFrame& frame) const {
  // By the light of less than a millionth of a lux fog is what lamps make of it, unless it stands
  // before a volume.
  const bool has_volumes = frame.Has(Effect::kVolumes) && media.HasVolumes();
  const bool is_lit = frame.Has(Effect::kFogGlow) &&
                      (has_volumes || Illuminance(frame.camera().eye(), frame.light) > 1e-6);
  LocalMedia here = media.Only(has_volumes, is_lit);
  frame.media = here.IsNothing()
                    ? nullptr
                    : std::make_shared<MediaLight>(
                          std::move(here), geometry, frame.model->air, frame.model->diffuse,
                          frame.light, frame.Has(Effect::kLights) ? frame.lamps.get() : nullptr);
}

// The same picture with fewer effects.
PictureFrame SceneState::Reduced(PictureFrame frame, EffectSet effects) const {
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
  if (!effects.Has(Effect::kLights)) frame.plan = std::make_shared<LampPlan>();
  if (!media_are_lit_alike) LightMedia(frame);
  if (!is_lit_alike) LightTerrain(frame);
  return frame;
}

}  // namespace alpenglow
