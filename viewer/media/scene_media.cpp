// SPDX-License-Identifier: MIT
#include "viewer/media/scene_media.h"

#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

std::vector<ShaderPiece> MediaTexts(const MediaKind& kind) {
  return kind.has_layer ? LayerTexts() : std::vector{ViewerPiece("viewer/shaders/media/none.glsl")};
}

SceneMedia::SceneMedia(const LocalMedia& media, const LayerMapSize& size, const MediaUnits& units)
    : media_(std::make_shared<const LocalMedia>(media.Only(false, true))) {
  if (!kind().has_layer) return;
  by_sun_.emplace(media_, size, units);
  by_moon_.emplace(media_, size, units);
}

MediaKind SceneMedia::kind() const { return {media_->HasLayers()}; }

double SceneMedia::ExtinctionAt(double altitude_m) const {
  return by_sun_ ? by_sun_->ExtinctionAt(altitude_m) : 0.0;
}

void SceneMedia::SetSize(const LayerMapSize& size) {
  for (std::optional<SceneLayer>* layer : {&by_sun_, &by_moon_})
    if (*layer) (*layer)->SetSize(size);
}

void SceneMedia::Follow(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                        const DistantLight& light) {
  std::optional<SceneLayer>& layer = light.body == LightSource::kMoon ? by_moon_ : by_sun_;
  if (layer) layer->Follow(air, eye, light);
}

void SceneMedia::WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                                const DistantLight& light) {
  std::optional<SceneLayer>& layer = light.body == LightSource::kMoon ? by_moon_ : by_sun_;
  if (layer) layer->WaitUntilReady(air, eye, light);
}

void SceneMedia::Connect(const ShaderProgram& program) const {
  if (by_sun_) by_sun_->Connect(program);
}

const SceneLayer& SceneMedia::Under(LightSource source) const {
  return source == LightSource::kMoon ? *by_moon_ : *by_sun_;
}

void SceneMedia::Bind(const CameraPose& eye, const DistantLight& first,
                      const DistantLight& second) const {
  if (!kind().has_layer) return;
  Under(first.body).Bind(eye, first, Under(second.body), second);
}

}  // namespace alpenglow::viewer
