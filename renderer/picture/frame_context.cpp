// SPDX-License-Identifier: MIT
#include "renderer/picture/frame_context.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <utility>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/cli/messages.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/picture/pixel_shader.h"

namespace alpenglow::renderer {
namespace {

LampPlan PlanOf(const FrameContext& frame) {
  // A lamp is negligible if all neglected lamps together change a grey card in daylight by less
  // than a thousandth.
  constexpr double kGreyCard = 0.18;
  const PreparedScene& scene = frame.scene();
  const CameraRays& camera = frame.camera();
  LampSettings lamp_settings = frame.settings().lamps;
  lamp_settings.floor_cd_per_m2 =
      std::max(lamp_settings.floor_cd_per_m2,
               1e-3 * kGreyCard / kPi * Illuminance(scene, camera.eye(), frame.light()));
  return frame.lamps().PlanFor(
      frame.moving(), frame.settings().width, frame.settings().height, lamp_settings,
      [&](const CameraRay& ray) {
        return scene.geometry().Trace(ray.origin, ray.direction, camera.PixelAngle()).distance_m;
      });
}

bool NeedsStokes(const CameraRays& camera, const std::vector<PictureLayer>& layers) {
  return camera.HasPolariser() || std::any_of(layers.begin(), layers.end(), IsOfPolarisation);
}

/// Returns the larger of the angles that a pixel spans where a direction appears; that of the
/// middle for a direction that does not.
double WidestPixelAt(const CameraRays& camera, const glm::dvec3& direction) {
  const auto place = camera.PlaceOf(direction);
  if (!place) return camera.PixelAngle();
  const auto [across_rad, down_rad] = camera.PixelExtentAt((*place)[0], (*place)[1]);
  return std::max(across_rad, down_rad);
}

/// Returns the middle rays of a picture's pixels, not refracted, up to what they meet.
/// @param geometry  of the scene, which outlives the picture.
PixelRays PixelRaysOf(const CameraRays& camera, const SceneGeometry& geometry,
                      const RenderSettings& settings) {
  const auto ray = [camera, &geometry](int column, int row) {
    const glm::dvec3 direction = camera.Direction(column + 0.5, row + 0.5);
    const Hit hit = geometry.Trace(camera.eye(), direction, camera.PixelAngle());
    return PixelRays::Ray{direction, hit.kind == HitKind::kSky
                                         ? std::numeric_limits<double>::infinity()
                                         : hit.distance_m};
  };
  return {settings.width, settings.height, camera.eye(), ray,
          [camera](const glm::dvec3& direction) { return camera.PlaceOf(direction); }};
}

/// Returns the mirror of level ground below an eye.
MirrorEye MirrorBelow(const glm::dvec3& eye, const SceneGeometry& geometry) {
  const glm::dvec3 up = geometry.UpAt(eye);
  const Hit below = geometry.Trace(eye, -up, 1e-3);
  const double height_m = below.kind == HitKind::kSky ? 0.0 : below.distance_m;
  return {eye - height_m * up, up, height_m, geometry.radius_m()};
}

}  // namespace

FrameContext::FrameContext(const PreparedScene& scene, const CameraSample& camera_sample,
                           const RenderSettings& settings)
    : scene_(&scene),
      settings_(settings),
      over_ground_(&scene.air().With(settings.effects)),
      moving_(CameraOn(scene.ground(), scene.scene().camera, camera_sample.poses, settings.width,
                       settings.height)),
      filter_(settings.filter),
      limb_(scene.geometry(), scene.medium(), camera(), filter_),
      is_polarised_(NeedsStokes(camera(), settings.layers)),
      lamps_(std::make_shared<LampLight>(scene.lamps().SeenBy(camera()))),
      plan_(std::make_shared<LampPlan>()) {
  const Observer observer = ObserverOf(scene, camera_sample);
  instant_ = observer.bodies.instant;
  Lighting sun = LightingAt(scene, observer);
  sun.effects = settings.effects;
  Spectrum by_sun(sun.source.irradiance.size());
  std::ranges::fill(by_sun.values(), 1.0F);
  lights_.push_back({std::move(sun), by_sun, std::make_shared<const TerrainSunlight>(), nullptr});
  if (Has(Effect::kRefraction)) refracted_ = RefractedViewRaysOf(*this, observer);
  if (Has(Effect::kShafts) && light().shows) {
    Prepare(settings.progress, "shadows");
    const auto made = scene.sunlight().At(light().source.direction.seen, light().source.radius_rad);
    lights_.front().shadows = made.sunlight;
    shadows_s_ = made.made_in_s;
  }
  if (Has(Effect::kLights)) {
    if (!scene.lamps().All().empty()) Prepare(settings.progress, "lamps");
    const Stopwatch watch;
    plan_ = std::make_shared<LampPlan>(PlanOf(*this));
    plan_s_ = watch.seconds();
  }
  LightNight();
  LightClouds();
  LightMedia();
  LightSpheres();
  LightTerrain();
  if (settings_.paths) AddPaths();
  if (Has(Effect::kStars)) AddStars(observer);
  AddSmallDisks();
}

void FrameContext::AddSmallDisks() {
  sky_lights_.small_sun = sky_lights_.small_moon = nullptr;
  constexpr double kRefracted = 2.0;  // a refracted disk is not wider than two radii
  const PixelShader shader(*this);
  const auto made = [&](const DiskInSky& disk) -> std::shared_ptr<const SmallDisk> {
    const double width_rad = 2.0 / kRefracted * disk.around_rad;
    if (width_rad >= WidestPixelAt(camera(), disk.to_disk)) return nullptr;
    return std::make_shared<const SmallDisk>(moving(), filter_, settings_.width, settings_.height,
                                             disk);
  };
  const auto is_open = [&](const CameraRay& ray) {
    return shader.Trace(ray).kind == HitKind::kSky;
  };
  const auto small_sun =
      made({light().source.direction.seen, kRefracted * light().source.radius_rad, glm::dvec3(0.0),
            [&](const glm::dvec3& from) { return shader.SunFrom(from); }, is_open});
  std::shared_ptr<const SmallDisk> small_moon;
  if (light().moon)
    small_moon = made({light().moon->direction.seen, kRefracted * light().moon->radius_rad,
                       light().moon_turn,
                       [&](const glm::dvec3& from) { return shader.MoonFrom(from); }, is_open});
  sky_lights_.small_sun = small_sun;
  sky_lights_.small_moon = small_moon;
}

void FrameContext::LightNight() {
  if (Has(Effect::kNightSky)) sky_lights_.night = light().night;
  if (!Has(Effect::kMoonlight) || !light().moonlight) return;
  FrameLight moon{light().By(*light().moonlight), Spectrum(light().source.irradiance.size()),
                  std::make_shared<const TerrainSunlight>(), nullptr};
  for (std::size_t band = 0; band < moon.by_sun.size(); ++band)
    moon.by_sun[band] = moon.light.source.irradiance[band] / light().source.irradiance[band];
  if (Has(Effect::kShafts))
    moon.shadows = scene_->moonlight()
                       .At(moon.light.source.direction.seen, moon.light.source.radius_rad)
                       .sunlight;
  lights_.push_back(std::move(moon));
}

void FrameContext::LightMedia() {
  // Below a millionth of a lux of sunlight, only lamps light layers, unless there are bodies, which a
  // layer can stand in front of.
  const SceneGeometry& geometry = scene_->geometry();
  const bool has_bodies = Has(Effect::kVolumes) && scene_->media().HasBodies();
  const bool is_lit = Has(Effect::kLayerGlow) &&
                      (has_bodies || lights_.size() > 1 ||
                       IlluminanceBy(*scene_, light().source, camera().eye(), light()) > 1e-6);
  LocalMedia here = scene_->media().Only(has_bodies, is_lit);
  for (FrameLight& source : lights_) source.media = nullptr;
  if (here.IsEmpty()) return;
  const auto past_clouds = [&](const FrameLight& source) -> CloudsOverMedia {
    if (!source.clouds || !Has(Effect::kCloudGlow)) return nullptr;
    return [clouds = source.clouds](double altitude_m) { return clouds->MeanAt(altitude_m); };
  };
  lights_.front().media =
      std::make_shared<MediaLight>(std::move(here), geometry, over_ground_->air, light(),
                                   Has(Effect::kLights) ? lamps_.get() : nullptr,
                                   MediaEmission::kOn, past_clouds(lights_.front()));
  for (std::size_t i = 1; i < lights_.size(); ++i) {
    lights_[i].media = std::make_shared<MediaLight>(media()->media(), geometry, over_ground_->air,
                                                    lights_[i].light, nullptr, MediaEmission::kOff,
                                                    past_clouds(lights_[i]));
  }
}

std::shared_ptr<const SolvedClouds> FrameContext::CloudsIn(const DistantLight& light) const {
  return scene_->clouds().At(instant_,
                             {light.direction.seen, geometry().AltitudeOf(camera().eye())});
}

void FrameContext::LightClouds() {
  for (FrameLight& source : lights_) source.clouds = nullptr;
  if (!scene_->clouds().HasAny() || !Has(Effect::kClouds)) return;
  Prepare(settings_.progress, "light of clouds");
  for (FrameLight& source : lights_) {
    const DistantLight& light = source.light.source;
    source.clouds = std::make_shared<const LitClouds>(
        CloudsIn(light), scene_->geometry(), over_ground_->air, light,
        CloudsInPicture{.method = settings_.cloud_light,
                        .pixels = PixelRaysOf(camera(), geometry(), settings_),
                        .past_terrain = source.shadows,
                        .has_colours = true,
                        .mirror = MirrorBelow(camera().eye(), geometry())});
  }
}

void FrameContext::LightSpheres() {
  for (FrameLight& source : lights_) source.caustics = nullptr;
  const std::vector<SpecularSphere>& spheres = scene_->spheres();
  if (spheres.empty()) return;
  double photons = 0.0;
  for (const SceneObject& object : scene_->scene().objects) photons += object.photons;
  for (FrameLight& source : lights_) {
    if (!source.light.shows) continue;
    const DistantLight& light = source.light.source;
    const auto lit = [&](const SpecularSphere& sphere) {
      return over_ground_->ground_light.InAir(sphere.centre, source.ground_sources());
    };
    std::optional<Spectrum> left;
    for (const SpecularSphere& sphere : spheres) {
      left = lit(sphere);
      if (left) break;
    }
    if (!left) continue;
    Prepare(settings_.progress, "caustics");
    source.caustics = std::make_shared<const Caustics>(
        SphereSurroundings{spheres,
                           geometry(),
                           {light.direction.seen, light.radius_rad},
                           light.irradiance * *left,
                           static_cast<int>(std::min(photons, kMostPhotons)),
                           scene_->scene().objects.front().photon_map,
                           camera().eye(),
                           camera().PixelAngle()},
        source.media ? std::optional(source.media->media()) : std::nullopt);
  }
}

void FrameContext::LightTerrain() {
  Prepare(settings_.progress, "light of slopes");
  if (Has(Effect::kHorizons)) scene_->PrepareHorizons();
  const Stopwatch watch;
  for (FrameLight& source : lights_) {
    if (source.light.shows)
      source.light.on_terrain = over_ground_->ground_light.OnTerrain(source.ground_sources());
  }
  slopes_s_ = watch.seconds();
}

void FrameContext::AddPaths() {
  for (FrameLight& source : lights_) {
    if (!source.light.shows) continue;
    std::shared_ptr<const CloudLayers> layers;
    std::vector<CloudPhases> phases;
    if (source.clouds) {
      layers = CloudsIn(source.light.source)->layers;
      std::ranges::transform(*layers, std::back_inserter(phases), PhasesOf);
    }
    source.paths = std::make_shared<const ScenePathTracer>(TracedScene{
        over_ground_->air.medium(), scene_->ground(), geometry(), over_ground_->ground_light,
        source.light, layers, std::move(phases), camera().PixelAngle()});
  }
}

void FrameContext::AddStars(const Observer& observer) {
  const double lux = Illuminance(*scene_, camera().eye(), light());
  if (!light().moon || lux > kDaylight_lux) return;
  const MoonDisk& moon = *light().moon;
  const glm::dmat3& frame_from_enu = observer.from_eye.axes();
  std::vector<StarLight> lights;
  const double pixel_rad = camera().PixelAngle();
  const RefractedView view(scene_->medium(), scene_->geometry().AltitudeOf(camera().eye()));
  for (StarLight& star : StarLightsOver(observer.bodies.place, observer.bodies.instant, view,
                                        scene_->colour(), FaintestStar(lux, pixel_rad),
                                        OpenFor(scene_->scene().camera.shutter_s, pixel_rad))) {
    star.direction = frame_from_enu * star.direction;
    for (glm::dvec3& direction : star.way) direction = frame_from_enu * direction;
    if (glm::length(star.direction - moon.direction.seen) >= moon.radius_rad)
      lights.push_back(std::move(star));
  }
  if (lights.empty()) return;
  const PixelShader shader(*this);
  sky_lights_.stars = std::make_shared<StarPixels>(
      camera(), settings_.width, settings_.height, lights,
      [&](double x, double y) { return shader.LeftOfSpace(x, y); },
      [&](double x, double y) {
        return shader.Trace(camera().MiddleRay(x, y)).kind != HitKind::kSky;
      });
}

FrameContext FrameContext::Reduced(EffectSet effects) const {
  constexpr EffectSet kThatLightTerrain{
      Effect::kHorizons,  Effect::kBounce,    Effect::kSkylight, Effect::kShadows,
      Effect::kLayerGlow, Effect::kVolumes,   Effect::kClouds,   Effect::kCloudShadows,
      Effect::kCloudGlow, Effect::kMolecules, Effect::kAerosol,  Effect::kOzone};
  constexpr EffectSet kThatLightMedia{Effect::kLayerGlow, Effect::kVolumes,   Effect::kLights,
                                      Effect::kClouds,    Effect::kCloudGlow, Effect::kMolecules,
                                      Effect::kAerosol,   Effect::kOzone};
  const auto are_alike = [&](EffectSet those) {
    return settings_.effects.And(those) == effects.And(those);
  };
  FrameContext frame = *this;
  frame.settings_.effects = effects;
  frame.over_ground_ = &scene_->air().With(effects);
  if (!effects.Has(Effect::kNightSky)) frame.sky_lights_.night = nullptr;
  if (!effects.Has(Effect::kStars)) frame.sky_lights_.stars = nullptr;
  if (!effects.Has(Effect::kRefraction)) frame.refracted_ = nullptr;
  if (!effects.Has(Effect::kMoonlight))
    frame.lights_.erase(frame.lights_.begin() + 1, frame.lights_.end());
  for (FrameLight& source : frame.lights_) {
    source.light.effects = effects;
    if (!effects.Has(Effect::kShafts)) source.shadows = std::make_shared<const TerrainSunlight>();
  }
  if (!effects.Has(Effect::kLights)) frame.plan_ = std::make_shared<LampPlan>();
  frame.LightClouds();
  if (!are_alike(kThatLightMedia)) frame.LightMedia();
  if (!are_alike(kThatLightMedia)) frame.LightSpheres();
  if (!are_alike(kThatLightTerrain)) frame.LightTerrain();
  frame.AddSmallDisks();
  return frame;
}

FrameContext FrameContext::Sampled(const RenderSettings& settings) const {
  FrameContext frame = *this;
  frame.settings_ = settings;
  return frame;
}

double FrameContext::PreparationSeconds(Effect effect) const {
  return effect == Effect::kShafts   ? shadows_s_
         : effect == Effect::kLights ? plan_s_
         : effect == Effect::kBounce ? slopes_s_
                                     : 0.0;
}

}  // namespace alpenglow::renderer
