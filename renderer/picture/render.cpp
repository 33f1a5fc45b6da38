// SPDX-License-Identifier: MIT
// Renders pictures with the effects that a scene needs: runs the preview of effect_choice.h with the
// scene's own pixels.
#include "renderer/picture/render.h"

#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/picture/prepared_scene.h"

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
    : state_(std::make_unique<PreparedScene>(scene, progress)) {}
SceneRenderer::SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground)
    : state_(std::make_unique<PreparedScene>(scene, std::move(ground))) {}
SceneRenderer::~SceneRenderer() = default;

const Medium& SceneRenderer::medium() const { return state_->medium; }
double SceneRenderer::eye_height_m() const { return state_->ground.eye_height_m; }
const std::string& SceneRenderer::terrain_message() const { return state_->ground.message; }

SunPosition SceneRenderer::ApparentSun(const CameraSample& camera_sample) const {
  return state_->ApparentSun(camera_sample);
}

double SceneRenderer::Illuminance(const CameraSample& camera_sample) const {
  const CameraStand stand = state_->StandOf(camera_sample);
  return state_->Illuminance(stand.eye, state_->LightingAt(camera_sample, stand));
}

Image SceneRenderer::Render(const CameraSample& camera_sample,
                            const RenderSettings& settings) const {
  return RenderCounted(camera_sample, settings).image;
}

CountedPicture SceneRenderer::RenderCounted(const CameraSample& camera_sample,
                                            const RenderSettings& settings) const {
  ValidateSettings(settings);
  const PreparedScene& state = state_->For(settings.effects);
  return state.Picture(state.FrameAt(camera_sample, settings));
}

std::unique_ptr<PreparedScene> PreparedScene::OnOtherBands(int bands) const {
  const std::optional<Medium> other = OnBands(scene.medium, bands);
  if (!other) return nullptr;
  Scene same = scene;
  same.medium = *other;
  return std::make_unique<PreparedScene>(same, shared_ground, this);
}

const PreparedScene& PreparedScene::OnFewBands() const {
  constexpr int kFew = 4;
  std::call_once(few_bands_asked, [&] {
    if (medium.wavelengths_nm.size() > kFew) few_bands = OnOtherBands(kFew);
  });
  return few_bands ? *few_bands : *this;
}

// Returns the effects that can change this picture.
EffectSet PreparedScene::Present(const FrameContext& frame) const {
  const auto without = [](EffectSet effects, bool is_there, EffectSet those) {
    if (is_there) return effects;
    for (const Effect effect : those.List()) effects = effects.Without(effect);
    return effects;
  };
  EffectSet present = EffectSet::All();
  const bool moon_is_broken = frame.moonlit && frame.moonlit->sunlight->IsBroken();
  present = without(present, frame.sunlight->IsBroken() || moon_is_broken, {Effect::kShafts});
  present = without(present, !lamps.All().empty(), {Effect::kLights, Effect::kBeams});
  present = without(present, ground.terrain.has_value(), {Effect::kShadows, Effect::kRelief});
  const bool is_terrain_lit =
      frame.light.on_terrain || (frame.moonlit && frame.moonlit->light.on_terrain);
  present = without(present, is_terrain_lit, {Effect::kHorizons, Effect::kBounce});
  present = without(present, media.HasVolumes(), {Effect::kVolumes});
  present = without(present, media.fog() != nullptr, {Effect::kFogGlow});
  present = without(present, frame.moonlit != nullptr, {Effect::kMoonlight});
  present = without(present, frame.night != nullptr, {Effect::kNightSky});
  present = without(present, frame.stars != nullptr, {Effect::kStars});
  present = without(present, frame.bent != nullptr, {Effect::kRefraction});
  return without(present, &OnFewBands() != this, {Effect::kFineSpectrum});
}

ChosenPicture SceneRenderer::RenderWithin(const CameraSample& camera_sample,
                                          const RenderSettings& settings,
                                          const EffectBudget& budget) const {
  ValidateSettings(settings);
  const PreparedScene& whole = state_->For(settings.effects);
  const FrameContext frame = whole.FrameAt(camera_sample, settings);
  std::optional<FrameContext> on_few_bands;
  const auto with = [&](EffectSet effects) {
    const PreparedScene& state = state_->For(effects);
    if (&state == &whole) return whole.Reduced(frame, effects);
    if (!on_few_bands) on_few_bands.emplace(state.FrameAt(camera_sample, settings));
    return state.Reduced(*on_few_bands, effects);
  };
  EffectPreview preview;
  std::vector<glm::dvec3> points = frame.lamps->Directions();
  if (frame.stars) {
    const auto& stars = frame.stars->directions();
    points.insert(points.end(), stars.begin(), stars.end());
  }
  preview.groups =
      PreviewPixels(frame.camera(), settings.width, settings.height, frame.light.to_sun, points);
  std::vector<PixelPlace> places;
  for (const auto& group : preview.groups) places.insert(places.end(), group.begin(), group.end());
  const auto timed = [&](const PreparedScene& state, const FrameContext& of) {
    const Stopwatch watch;
    Image image = state.Pixels(of, places);
    return PreviewPicture{std::move(image), watch.seconds()};
  };
  preview.render = [&](EffectSet effects) { return timed(state_->For(effects), with(effects)); };
  preview.pixels_of_picture = static_cast<double>(settings.width) * settings.height;
  preview.preparation_s = [&](Effect effect) {
    return effect == Effect::kShafts   ? frame.sunlight_s
           : effect == Effect::kLights ? frame.plan_s
           : effect == Effect::kBounce ? frame.slopes_s
                                       : 0.0;
  };
  Prepare(settings.progress, "choice of effects");
  preview.present = whole.Present(frame);
  const auto refine = [&](const char* name, const auto& change) {
    preview.refinements.push_back({name, [&, change] {
                                     FrameContext finer = frame;
                                     change(finer.settings);
                                     return timed(whole, finer);
                                   }});
  };
  refine("16 air nodes", [](RenderSettings& finer) { finer.air_nodes = 16; });
  refine("air of each ray", [](RenderSettings& finer) { finer.share_air = false; });
  const std::unique_ptr<PreparedScene> more_bands =
      budget.explain ? whole.OnOtherBands(16) : nullptr;
  if (more_bands && frame.model->air.bands() < 16) {
    preview.refinements.push_back(
        {"16 bands",
         [&] { return timed(*more_bands, more_bands->FrameAt(camera_sample, settings)); }});
  }
  EffectChoice choice = ChooseEffects(preview, settings.effects, budget);
  CountedPicture picture = state_->For(choice.effects).Picture(with(choice.effects));
  return {std::move(picture.image), picture.rays, std::move(choice)};
}

}  // namespace alpenglow::renderer
