// SPDX-License-Identifier: MIT
// A FogMap on the graphics card, for fog_light.glsl.
#pragma once

#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/lamps/fog_map.h"

namespace alpenglow::viewer {

/// `block Fog` of fog_light.glsl.
struct FogBlock {
  glm::vec4 layer, eye, sun, phase, map_size;
};
static_assert(sizeof(FogBlock) == 5 * sizeof(glm::vec4));

/// Texts for a fragment stage, after SharedTexts(): FogTo(direction, distance_km) and the rest of
/// fog_light.glsl. @param kind  of the fog's phase function.
[[nodiscard]] std::vector<ShaderPiece> FogTexts(PhaseKind kind);

/// The same functions where there is no fog.
[[nodiscard]] std::vector<ShaderPiece> NoFogTexts();

/// Where what fog reads is bound.
struct FogUnits {
  GLuint block = 9;
  int first = 13;  // of two texture units
};

class FogPainter {
 public:
  explicit FogPainter(const FogUnits& units) : units_(units) {}
  void Connect(const ShaderProgram& program) const;
  /// Takes a map in.
  void Upload(const FogMap& map);
  /// For the next draw of a program of FogTexts(). @param map  that was taken in last.
  void Bind(const FogMap& map, const FogView& now) const;

 private:
  FogUnits units_;
  GlBuffer block_;
  GlTexture light_, surface_;
};

}  // namespace alpenglow::viewer
