// SPDX-License-Identifier: MIT
#include "viewer/lamps/fog_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/lamps/phase_macro.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

constexpr double kMetres = 1000.0;

void Activate(int unit) { glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit)); }

// @param now  eye and sun, which may have moved since the map was made.
FogBlock FogBlockOf(const FogMap& map, const FogView& now) {
  FogBlock block{};
  const double height_km = std::isinf(map.scale_height_m) ? 0.0 : map.scale_height_m / kMetres;
  block.layer = {map.extinction_per_m * kMetres, height_km, map.base_m / kMetres,
                 map.top_m / kMetres};
  block.eye = {std::max(now.altitude_m, 0.0) / kMetres, map.radius_m / kMetres, map.depth,
               map.peak_scale};
  block.sun = {glm::vec3(now.to_sun), map.broad_g};
  block.phase = ParametersOf(map.phase);
  block.map_size = {map.size.elevations, map.size.azimuths, map.size.depths, 0.0};
  return block;
}

}  // namespace

std::vector<ShaderPiece> FogTexts(PhaseKind kind) {
  return {{"fog constants", fmt::format("#define FOG_PHASE(c, p) {}\n", PhaseExpression(kind))},
          ViewerPiece("viewer/shaders/fog_light.glsl")};
}

std::vector<ShaderPiece> NoFogTexts() { return {ViewerPiece("viewer/shaders/no_fog.glsl")}; }

void FogPainter::Connect(const ShaderProgram& program) const {
  program.Use();
  program.BindBlock("Fog", units_.block);
  program.BindSampler("fog_light_map", units_.first);
  program.BindSampler("fog_surface_map", units_.first + 1);
}

void FogPainter::Upload(const FogMap& map) {
  Activate(units_.first);
  glBindTexture(GL_TEXTURE_3D, light_.id());
  glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, map.size.elevations, map.size.azimuths,
               4 * map.size.depths, 0, GL_RGBA, GL_FLOAT, map.light.data());
  ClampAndFilter(GL_TEXTURE_3D, true);
  Activate(units_.first + 1);
  glBindTexture(GL_TEXTURE_2D, surface_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, FogMap::kHeights, 2, 0, GL_RGBA, GL_FLOAT,
               map.on_surface.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
  CheckGl("FogPainter::Upload");
}

void FogPainter::Bind(const FogMap& map, const FogView& now) const {
  const FogBlock block = FogBlockOf(map, now);
  glBindBufferBase(GL_UNIFORM_BUFFER, units_.block, block_.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
  Activate(units_.first);
  glBindTexture(GL_TEXTURE_3D, light_.id());
  Activate(units_.first + 1);
  glBindTexture(GL_TEXTURE_2D, surface_.id());
}

}  // namespace alpenglow::viewer
