// SPDX-License-Identifier: MIT
// Provides the light of sun and sky in a scene's fog on the GPU: FogPainter, which uploads a FogMap
// (renderer/media/fog_map.h) for fog/light.glsl, and SceneFog, which computes maps for a moving
// eye and sun beside drawing.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/media/fog_map.h"
#include "renderer/media/local_media.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Mirrors the uniform block `Fog` of fog/light.glsl.
struct FogBlock {
  glm::vec4 layer, eye, sun, phase, map_size, other_sun;
};
static_assert(sizeof(FogBlock) == 6 * sizeof(glm::vec4));

/// Returns texts for a fragment stage, which follow SharedTexts(): MediaTo(direction, distance_km)
/// and the rest of fog/light.glsl. @param kind  kind of the fog's phase function.
[[nodiscard]] std::vector<ShaderPiece> FogTexts(PhaseKind kind);

/// Returns texts with these functions for scenes without fog.
[[nodiscard]] std::vector<ShaderPiece> NoFogTexts();

/// Binding points of the data of media.
struct MediaUnits {
  GLuint block = 9;
  int first = 13;  // first of four texture units: two for each light of the sky
};

class FogPainter {
 public:
  explicit FogPainter(const MediaUnits& units) : units_(units) {}
  void Connect(const ShaderProgram& program) const;
  /// Uploads a map.
  void Upload(const FogMap& map);
  /// Binds everything for the next draw call of a program of FogTexts(). @param map  the last
  /// uploaded map.
  void Bind(const FogMap& map, const FogView& now) const;
  /// Binds the fog for a program with TWO_LIGHTS.
  /// @param other  the painter of the second light, whose map has the same size.
  void Bind(const FogMap& map, const FogView& now, const FogPainter& other,
            const FogView& other_now) const;

 private:
  void Bind(const FogBlock& block) const;

  MediaUnits units_;
  GlBuffer block_;
  GlTexture light_, surface_;
};

class SceneFog {
 public:
  /// @param media  media with a layer, the fog.
  SceneFog(std::shared_ptr<const LocalMedia> media, const LayerMapSize& size,
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

  /// Returns the extinction of the fog at an altitude [1/m].
  [[nodiscard]] double ExtinctionAt(double altitude_m) const;

  /// Connects a program of FogTexts() with the bound data.
  void Connect(const ShaderProgram& program) const { painter_.Connect(program); }
  /// Binds everything for the next draw call of such a program. Call it after Follow or
  /// WaitUntilReady.
  void Bind(const CameraPose& eye, const DistantLight& light) const;
  /// Binds the fog for a program with TWO_LIGHTS. @param other  the fog lit by the second light.
  void Bind(const CameraPose& eye, const DistantLight& light, const SceneFog& other,
            const DistantLight& other_light) const;

 private:
  void BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad);

  std::shared_ptr<const LocalMedia> media_;
  LayerMapSize size_;
  FogPainter painter_;
  std::shared_ptr<const SolvedAir> air_;  // medium of the maps; null: no map of this size yet
  std::optional<AsyncValue<FogView, FogMap>> maps_;
};

}  // namespace alpenglow::viewer
