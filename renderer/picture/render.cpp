// SPDX-License-Identifier: MIT
// Renders pictures with the effects that a scene needs: runs the preview of effect_choice.h with
// the scene's own pixels.
#include "renderer/picture/render.h"

#include <algorithm>
#include <optional>

#include "atmosphere/base/error.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/picture/scene_lighting.h"
#include "renderer/picture/tile_renderer.h"

namespace alpenglow::renderer {

void ValidateSettings(const RenderSettings& settings) {
  RequireInRange(settings.width, 1, 16384, "picture width");
  RequireInRange(settings.height, 1, 16384, "picture height");
  RequireInRange(settings.samples_per_pixel, 1, PixelSamples::kMostSamples, "samples per pixel");
  if (settings.noise) {
    RequireInRange(*settings.noise, 1e-8, 1.0, "noise");
    RequireInRange(settings.samples_per_pixel, 2, PixelSamples::kMostSamples,
                   "samples per pixel, with noise,");
  }
  RequireInRange(settings.air_nodes, 2, 32, "air nodes");
}

SceneRenderer::SceneRenderer(const Scene& scene, Progress* progress)
    : scene_(std::make_unique<PreparedScene>(scene, progress)) {}
SceneRenderer::SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground)
    : scene_(std::make_unique<PreparedScene>(scene, std::move(ground))) {}
SceneRenderer::~SceneRenderer() = default;

const Medium& SceneRenderer::medium() const { return scene_->medium(); }
double SceneRenderer::eye_height_m() const { return scene_->ground().eye_height_m; }
const std::string& SceneRenderer::terrain_message() const { return scene_->ground().message; }

SunPosition SceneRenderer::ApparentSun(const CameraSample& camera_sample) const {
  return ObserverOf(*scene_, camera_sample).bodies.ApparentSun(GentleAirOf(scene_->medium()));
}

SkyBodies SceneRenderer::BodiesOver(const CameraSample& camera_sample) const {
  return ObserverOf(*scene_, camera_sample).bodies;
}

double SceneRenderer::Illuminance(const CameraSample& camera_sample) const {
  const Observer observer = ObserverOf(*scene_, camera_sample);
  return renderer::Illuminance(*scene_, observer.stand.eye, LightingAt(*scene_, observer));
}

Image SceneRenderer::Render(const CameraSample& camera_sample,
                            const RenderSettings& settings) const {
  return RenderCounted(camera_sample, settings).image;
}

CountedPicture SceneRenderer::RenderCounted(const CameraSample& camera_sample,
                                            const RenderSettings& settings) const {
  ValidateSettings(settings);
  return TileRenderer({scene_->For(settings.effects), camera_sample, settings}).Picture();
}

namespace {

/// Returns the effects that can change this picture.
EffectSet Present(const FrameContext& frame) {
  const auto without = [](EffectSet effects, bool is_there, EffectSet those) {
    if (is_there) return effects;
    for (const Effect effect : those.List()) effects = effects.Without(effect);
    return effects;
  };
  EffectSet present = EffectSet::All();
  const PreparedScene& scene = frame.scene();
  const auto any_light = [&](const auto& holds) {
    return std::any_of(frame.lights().begin(), frame.lights().end(), holds);
  };
  const bool is_broken = any_light([](const FrameLight& of) { return of.shadows->IsBroken(); });
  present = without(present, is_broken, {Effect::kShafts});
  present = without(present, !scene.lamps().All().empty(), {Effect::kLights, Effect::kBeams});
  present =
      without(present, scene.ground().terrain.has_value(), {Effect::kShadows, Effect::kRelief});
  const bool is_terrain_lit =
      any_light([](const FrameLight& of) { return of.light.on_terrain != nullptr; });
  present = without(present, is_terrain_lit, {Effect::kHorizons, Effect::kBounce});
  present = without(present, scene.media().HasVolumes(), {Effect::kVolumes});
  present = without(present, scene.media().fog() != nullptr, {Effect::kFogGlow});
  present = without(present, frame.lights().size() > 1, {Effect::kMoonlight});
  present = without(present, frame.night() != nullptr, {Effect::kNightSky});
  present = without(present, frame.stars() != nullptr, {Effect::kStars});
  present = without(present, frame.bent() != nullptr, {Effect::kRefraction});
  return without(present, &scene.OnFewBands() != &scene, {Effect::kFineSpectrum});
}

}  // namespace

ChosenPicture SceneRenderer::RenderWithin(const CameraSample& camera_sample,
                                          const RenderSettings& settings,
                                          const EffectBudget& budget) const {
  ValidateSettings(settings);
  const FrameContext frame(scene_->For(settings.effects), camera_sample, settings);
  std::optional<FrameContext> on_few_bands;
  const auto with = [&](EffectSet effects) {
    const PreparedScene& scene = scene_->For(effects);
    if (&scene == &frame.scene()) return frame.Reduced(effects);
    if (!on_few_bands) on_few_bands.emplace(scene, camera_sample, settings);
    return on_few_bands->Reduced(effects);
  };
  EffectPreview preview;
  std::vector<glm::dvec3> points = frame.lamps().Directions();
  if (frame.stars() != nullptr) {
    const auto& stars = frame.stars()->directions();
    points.insert(points.end(), stars.begin(), stars.end());
  }
  preview.groups =
      PreviewPixels(frame.camera(), settings.width, settings.height, frame.light().to_sun, points);
  std::vector<PixelPlace> places;
  for (const auto& group : preview.groups) places.insert(places.end(), group.begin(), group.end());
  const auto timed = [&](const FrameContext& of) {
    const Stopwatch watch;
    Image image = TileRenderer(of).Pixels(places);
    return PreviewPicture{std::move(image), watch.seconds()};
  };
  preview.render = [&](EffectSet effects) { return timed(with(effects)); };
  preview.pixels_of_picture = static_cast<double>(settings.width) * settings.height;
  preview.preparation_s = [&](Effect effect) { return frame.PreparationSeconds(effect); };
  Prepare(settings.progress, "choice of effects");
  preview.present = Present(frame);
  const auto refine = [&](const char* name, const auto& change) {
    preview.refinements.push_back({name, [&, change] {
                                     RenderSettings finer = frame.settings();
                                     change(finer);
                                     return timed(frame.Sampled(finer));
                                   }});
  };
  refine("16 air nodes", [](RenderSettings& finer) { finer.air_nodes = 16; });
  refine("air of each ray", [](RenderSettings& finer) { finer.share_air = false; });
  const std::unique_ptr<PreparedScene> more_bands =
      budget.explain ? frame.scene().OnOtherBands(16) : nullptr;
  if (more_bands && frame.model().air.bands() < 16) {
    preview.refinements.push_back({"16 bands", [&] {
                                     return timed({*more_bands, camera_sample, settings});
                                   }});
  }
  EffectChoice choice = ChooseEffects(preview, settings.effects, budget);
  CountedPicture picture = TileRenderer(with(choice.effects)).Picture();
  return {std::move(picture.image), picture.rays, std::move(choice)};
}

}  // namespace alpenglow::renderer
