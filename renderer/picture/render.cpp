// SPDX-License-Identifier: MIT
#include "renderer/picture/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/refraction.h"
#include "atmosphere/sun/sun_disk.h"
#include "atmosphere/text/error.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/program/program.h"
#include "renderer/camera/pixel_samples.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/camera_stand.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/ground/terrain_sunlight.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/light/ground_light.h"
#include "renderer/picture/air_model.h"
#include "renderer/picture/pixel_writer.h"
#include "renderer/picture/scene_state.h"
#include "renderer/picture/shared_air.h"

namespace alpenglow {
namespace {

/// Lamps that no ray comes near.
const LampTile& DarkTile() {
  static const LampTile kDark;
  return kDark;
}

}  // namespace

BandLight SceneRenderer::State::SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                        const Lighting& light) const {
  // Angle from the chord: the arc cosine of a number near 1 has no digits left.
  const double chord = glm::length(direction - light.to_sun);
  const double rho = 2.0 * std::asin(std::min(0.5 * chord, 1.0)) / light.sun_radius_rad;
  if (rho >= 1.0) return BandLight(light.irradiance.count);
  const auto scale = static_cast<float>(LimbDarkening(rho) / DiskSolidAngle(light.sun_radius_rad));
  return scale * (light.irradiance * through.transmittance);
}

Shaded SceneRenderer::State::Shade(const Hit& hit, const SharedAir& through, const CameraRay& ray,
                                   const PictureFrame& frame, const LampTile& near,
                                   std::array<double, 2> disk_sample) const {
  Shaded shaded;
  shaded.inscatter = through.fog * (frame.light.irradiance * through.air.inscatter);
  shaded.transmittance = through.fog * through.air.transmittance;
  shaded.albedo = BandLight(medium.wavelengths_nm.size());
  const auto left = [&](double distance_m) {
    return LeftByVolumes(through.pieces, distance_m, through.media.count);
  };
  shaded.lamps =
      through.lamp_light + frame.lamps->Seen(near.seen, ray, frame.camera().PixelAngle(), left);
  shaded.volumes = through.media;
  shaded.radiance = shaded.inscatter + shaded.lamps + shaded.volumes;
  if (hit.kind == HitKind::kSky) {
    shaded.radiance =
        shaded.radiance + through.fog * SunDisk(ray.direction, through.air, frame.light);
    return shaded;
  }
  const GroundRadiance sent = frame.model->ground_light.Towards(hit, -ray.direction, frame.light,
                                                                near.surface, disk_sample);
  shaded.albedo = sent.albedo;
  shaded.sun_visibility = sent.sun_visibility;
  const BandLight lamp_light = shaded.transmittance * sent.lamps;
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * sent.natural;
  return shaded;
}

double SceneRenderer::State::Illuminance(const glm::dvec3& eye, const Lighting& light) const {
  const LocalSun sun = models.whole().ground_light.LocalSunAt(eye, light);
  const auto direct = static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const BandLight irradiance =
      direct * models.whole().air.TransmittanceToSpace(sun.altitude_m, sun.mu_s_effective) +
      models.whole().diffuse.SkyIrradiance(sun.altitude_m, sun.mu_s);
  return colour.Xyz(InDouble(light.irradiance * irradiance))[1];
}

LampPlan SceneRenderer::State::PlanLamps(const PictureFrame& frame) const {
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

namespace {

/// A ray of a pixel and the air it looks through.
struct PixelRay {
  CameraRay ray;
  Hit hit;
  std::size_t air;
};

/// Of a ray, from the pixel's upper left corner [pixels].
glm::dvec2 PlaceInPixel(const PixelSamples& samples, int sample, const PictureFrame& frame) {
  if (frame.settings.samples_per_pixel == 1) return {0.5, 0.5};
  const auto [u, v] = samples.Point(sample, SampleOf::kPixel);
  return {0.5 + frame.filter.Offset(u), 0.5 + frame.filter.Offset(v)};
}

CameraRay RayOf(const PixelSamples& samples, int sample, const glm::dvec2& at,
                const PictureFrame& frame) {
  std::array<double, 2> lens{};
  double time = 0.0;
  if (frame.camera().HasLens()) lens = samples.Point(sample, SampleOf::kLens);
  if (frame.moving.IsMoving()) time = samples.Point(sample, SampleOf::kTime)[0];
  return frame.moving.Ray(at.x, at.y, lens, time);
}

}  // namespace

void ValidateSettings(const RenderSettings& settings) {
  RequireInRange(settings.width, 1, 16384, "picture width");
  RequireInRange(settings.height, 1, 16384, "picture height");
  RequireInRange(settings.samples_per_pixel, 1, PixelSamples::kMostSamples, "samples per pixel");
  RequireInRange(settings.air_nodes, 2, 32, "air nodes");
}

SceneRenderer::SceneRenderer(const Scene& scene) : state_(std::make_unique<State>(scene)) {}
SceneRenderer::~SceneRenderer() = default;

const Medium& SceneRenderer::medium() const { return state_->medium; }
double SceneRenderer::eye_height_m() const { return state_->ground.eye_height_m; }
const std::string& SceneRenderer::terrain_message() const { return state_->ground.message; }

SunPosition SceneRenderer::State::ApparentSun(const Shot& shot) const {
  GeodeticPosition eye = scene.place;
  eye.height_m = ground.eye_height_m;
  if (const auto pose = shot.middle()) eye = pose->place;
  SunPosition sun = SunAt(eye, shot.instant);
  sun.elevation_rad += RefractionFromHeight(sun.elevation_rad, eye.height_m);
  return sun;
}

CameraStand SceneRenderer::State::StandOf(const Shot& shot) const {
  const auto pose = shot.middle();
  return pose ? StandAt(ground, pose->place) : StandOfScene(ground);
}

Lighting SceneRenderer::State::LightingAt(const Shot& shot, const CameraStand& stand) const {
  Lighting light = LightingOf(ApparentSun(shot), shot.instant, scene.place.latitude_rad, medium);
  light.to_sun = stand.frame_from_enu * light.to_sun;
  return light;
}

SunPosition SceneRenderer::ApparentSun(const Shot& shot) const { return state_->ApparentSun(shot); }

double SceneRenderer::Illuminance(const Shot& shot) const {
  const CameraStand stand = state_->StandOf(shot);
  return state_->Illuminance(stand.eye, state_->LightingAt(shot, stand));
}

PictureFrame SceneRenderer::State::FrameAt(
    const Shot& shot, const RenderSettings& settings,
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
    const Stopwatch watch;
    frame.sunlight = known ? known
                           : std::make_shared<TerrainSunlight>(ground, frame.light.to_sun,
                                                               frame.light.sun_radius_rad);
    frame.sunlight_s = watch.seconds();
  }
  if (frame.Has(Effect::kLights)) {
    const Stopwatch watch;
    frame.plan = std::make_shared<LampPlan>(PlanLamps(frame));
    frame.plan_s = watch.seconds();
  }
  LightMedia(frame);
  LightTerrain(frame);
  return frame;
}

void SceneRenderer::State::LightTerrain(PictureFrame& frame) const {
  if (frame.Has(Effect::kHorizons)) (void)horizons->Get();  // made once, for all frames
  const Stopwatch watch;
  frame.light.on_terrain = frame.model->ground_light.OnTerrain(frame.light);
  frame.slopes_s = watch.seconds();
}

void SceneRenderer::State::LightMedia(PictureFrame& frame) const {
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
  frame.light.media = frame.media.get();
}

// The same picture with fewer effects.
PictureFrame SceneRenderer::State::Reduced(PictureFrame frame, EffectSet effects) const {
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

Image SceneRenderer::State::Pixels(const PictureFrame& frame,
                                   const std::vector<PixelPlace>& places) const {
  RenderSettings row = frame.settings;
  row.width = static_cast<int>(places.size());
  row.height = 1;
  row.layers.clear();
  PixelWriter writer(colour, row);
  tbb::parallel_for(0, row.width, [&](int i) {
    const PixelPlace& at = places[static_cast<std::size_t>(i)];
    if (!Interrupted()) writer.Write(i, 0, Pixel(frame, at.x, at.y));
  });
  ThrowIfInterrupted();
  return writer.Take();
}

Image SceneRenderer::State::Picture(const PictureFrame& frame) const {
  PixelWriter writer(colour, frame.settings);
  ThrowIfInterrupted();
  tbb::parallel_for(0, frame.settings.height, [&](int y) {
    if (Interrupted()) return;
    for (int x = 0; x < frame.settings.width; ++x) {
      writer.Write(x, y, Pixel(frame, x, y));
      if (!writer.AsksForMiddle()) continue;
      writer.WriteMiddle(x, y, Trace(frame.camera().MiddleRay(x + 0.5, y + 0.5), frame));
    }
  });
  ThrowIfInterrupted();
  return writer.Take();
}

std::vector<Shaded> SceneRenderer::State::Pixel(const PictureFrame& frame, int x, int y) const {
  const PixelSamples samples(x, y, frame.settings.samples_per_pixel);
  std::vector<PixelRay> rays;
  rays.reserve(static_cast<std::size_t>(frame.settings.samples_per_pixel));
  std::vector<SharedAir> airs;
  for (int i = 0; i < frame.settings.samples_per_pixel; ++i) {
    const glm::dvec2 at = glm::dvec2(x, y) + PlaceInPixel(samples, i, frame);
    const CameraRay ray = RayOf(samples, i, at, frame);
    const Hit hit = Trace(ray, frame);
    rays.push_back({ray, hit, AirFor(hit, ray.through, frame, airs)});
  }
  // The filter is symmetric: the mean of all its rays is known better than the mean of some.
  if (airs.size() == 1 && !frame.moving.IsMoving()) {
    airs.front().direction_sum = frame.camera().Direction(x + 0.5, y + 0.5);
  }
  const LampTile& near = frame.plan->tiles.empty() ? DarkTile() : frame.plan->At(x, y);
  for (SharedAir& shared : airs) {
    AddAir(frame, geometry, medium, shared);
    AddLamps(frame, x, y, shared);
  }
  std::vector<Shaded> shaded;
  shaded.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    shaded.push_back(Shade(rays[i].hit, airs[rays[i].air], rays[i].ray, frame, near,
                           samples.Point(static_cast<int>(i), SampleOf::kSunDisk)));
  }
  return shaded;
}

Image SceneRenderer::Render(const Shot& shot, const RenderSettings& settings) const {
  ValidateSettings(settings);
  const State& state = state_->For(settings.effects);
  return state.Picture(state.FrameAt(shot, settings));
}

}  // namespace alpenglow
