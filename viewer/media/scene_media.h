// SPDX-License-Identifier: MIT
// Provides the media of a scene on the GPU: the shader texts that return their light, and their data
// under each light of the sky. Of all media, the first layer is drawn (scene_layer.h). Without a layer, the
// texts return no light, and nothing is computed or bound.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/media/layer_map.h"
#include "renderer/media/local_media.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"
#include "viewer/media/scene_layer.h"

namespace alpenglow::viewer {

/// The properties of media that shader texts depend on.
struct MediaKind {
  bool has_layer = false;

  /// Returns the number of textures that a program reads.
  [[nodiscard]] int Textures(int lights) const { return has_layer ? 2 * lights : 0; }
};

/// Returns texts for a fragment stage, which follow SharedTexts(): MediaTo(direction, distance_km)
/// and the rest of media/layer.glsl.
[[nodiscard]] std::vector<ShaderPiece> MediaTexts(const MediaKind& kind);

class SceneMedia {
 public:
  SceneMedia(const LocalMedia& media, const LayerMapSize& size, const MediaUnits& units);

  [[nodiscard]] MediaKind kind() const;
  /// Returns the extinction at an altitude [1/m].
  [[nodiscard]] double ExtinctionAt(double altitude_m) const;

  /// Sets the size of maps from the next Follow or WaitUntilReady on.
  void SetSize(const LayerMapSize& size);
  /// Takes finished light and requests missing light. Call it once a frame for each light of the
  /// sky. It waits only for the first time in a medium.
  void Follow(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
              const DistantLight& light);
  /// Waits for the light of the view.
  void WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                      const DistantLight& light);

  /// Connects a program of MediaTexts() with the bound data.
  void Connect(const ShaderProgram& program) const;
  /// Binds everything for the next draw call of such a program, which has TWO_LIGHTS if the lights
  /// differ. Call it after Follow or WaitUntilReady.
  void Bind(const CameraPose& eye, const DistantLight& first, const DistantLight& second) const;

 private:
  [[nodiscard]] const SceneLayer& Under(LightSource source) const;

  std::shared_ptr<const LocalMedia> media_;
  std::optional<SceneLayer> by_sun_, by_moon_;  // both or none
};

}  // namespace alpenglow::viewer
