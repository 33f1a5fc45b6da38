// SPDX-License-Identifier: MIT
#include "renderer/picture/render.h"

#include "renderer/picture/scene_state.h"

namespace alpenglow::renderer {

SceneRenderer::SceneRenderer(const Scene& scene, Progress* progress)
    : state_(std::make_unique<SceneState>(scene, progress)) {}
SceneRenderer::SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground)
    : state_(std::make_unique<SceneState>(scene, std::move(ground))) {}
SceneRenderer::~SceneRenderer() = default;

const Medium& SceneRenderer::medium() const { return state_->medium; }
double SceneRenderer::eye_height_m() const { return state_->ground.eye_height_m; }
const std::string& SceneRenderer::terrain_message() const { return state_->ground.message; }

SunPosition SceneRenderer::ApparentSun(const Shot& shot) const { return state_->ApparentSun(shot); }

double SceneRenderer::Illuminance(const Shot& shot) const {
  const CameraStand stand = state_->StandOf(shot);
  return state_->Illuminance(stand.eye, state_->LightingAt(shot, stand));
}

Image SceneRenderer::Render(const Shot& shot, const RenderSettings& settings) const {
  return RenderCounted(shot, settings).image;
}

CountedPicture SceneRenderer::RenderCounted(const Shot& shot,
                                            const RenderSettings& settings) const {
  ValidateSettings(settings);
  const SceneState& state = state_->For(settings.effects);
  return state.Picture(state.FrameAt(shot, settings));
}

}  // namespace alpenglow::renderer
