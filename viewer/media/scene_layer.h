// SPDX-License-Identifier: MIT
// Provides the light of sun and sky in a layer of a scene on the GPU: LayerPainter, which uploads a
// LayerMap (renderer/media/layer_map.h) for media/layer.glsl, and SceneLayer, which computes maps for
// a moving eye and sun beside drawing.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/media/layer_map.h"
#include "renderer/media/local_media.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Mirrors the uniform block `Layer` of media/layer.glsl.
struct LayerBlock {
  glm::vec4 shape, eye, sun, map_size, other_sun;
};
static_assert(sizeof(LayerBlock) == 5 * sizeof(glm::vec4));

/// Returns texts for a fragment stage, which follow SharedTexts(): MediaTo(direction, distance_km)
/// and the rest of media/layer.glsl.
[[nodiscard]] std::vector<ShaderPiece> LayerTexts();

/// Binding points of the data of media.
struct MediaUnits {
  GLuint block = 9;
  int first = 13;  // first of four texture units: two for each light of the sky
};

class LayerPainter {
 public:
  explicit LayerPainter(const MediaUnits& units) : units_(units) {}
  void Connect(const ShaderProgram& program) const;
  /// Uploads a map.
  void Upload(const LayerMap& map);
  /// Binds everything for the next draw call of a program of LayerTexts().
  /// @param map  the last uploaded map.
  /// @param other  the painter of the second light, whose map has the same size; this one if there
  ///     is one light.
  void Bind(const LayerMap& map, const EyeUnderLight& now, const LayerPainter& other,
            const EyeUnderLight& other_now) const;

 private:
  MediaUnits units_;
  GlBuffer block_;
  GlTexture light_, surface_;
};

class SceneLayer {
 public:
  /// @param media  media with a layer.
  SceneLayer(std::shared_ptr<const LocalMedia> media, const LayerMapSize& size,
             const MediaUnits& units);

  /// Sets the size of maps from the next Follow or WaitUntilReady on.
  void SetSize(const LayerMapSize& size);

  /// Takes a finished map and requests a missing one. Call it once a frame. It waits only for the
  /// first map in a medium.
  /// @param light  in the frame east, north, up of the eye.
  void Follow(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
              const DistantLight& light);
  /// Waits for the map of the view.
  void WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                      const DistantLight& light);

  /// Returns the extinction of the layer at an altitude [1/m].
  [[nodiscard]] double ExtinctionAt(double altitude_m) const;

  /// Connects a program of LayerTexts() with the bound data.
  void Connect(const ShaderProgram& program) const { painter_.Connect(program); }
  /// Binds everything for the next draw call of such a program. Call it after Follow or
  /// WaitUntilReady.
  /// @param other  the layer lit by the second light; this one if there is one light.
  void Bind(const CameraPose& eye, const DistantLight& light, const SceneLayer& other,
            const DistantLight& other_light) const;

 private:
  void BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad);

  std::shared_ptr<const LocalMedia> media_;
  LayerMapSize size_;
  LayerPainter painter_;
  std::shared_ptr<const SolvedAir> air_;  // medium of the maps; null: no map of this size yet
  std::optional<AsyncValue<EyeUnderLight, LayerMap>> maps_;
};

}  // namespace alpenglow::viewer
