// SPDX-License-Identifier: MIT
#include "viewer/land/land_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/block_bindings.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

// Nodes of the grid are at texel centres.
PlaceOnGrid PlaceOnGridOf(const HeightRaster& grid, const LocalFrame& of_grid,
                          const LocalFrame& of_places) {
  const FrameTransform to_grid(of_grid, of_places);
  const auto row = [&](glm::length_t axis, double first_m, int nodes) {
    const double scale = 1.0 / (grid.cell_m * nodes);
    const glm::dmat3& turned = to_grid.axes();
    const double offset_m = to_grid.origin_m()[axis] - first_m + 0.5 * grid.cell_m;
    return glm::vec4(glm::dvec4(turned[0][axis], turned[1][axis], turned[2][axis], offset_m) *
                     scale);
  };
  return {row(0, grid.first_x_m, grid.columns), row(1, grid.first_y_m, grid.rows)};
}

void HorizonTexture::Use(const TerrainHorizon& horizon) {
  if (horizon_ && horizon_->map == horizon.map) return;
  horizon_ = horizon;
  azimuth_rad_ = std::nullopt;
}

PlaceOnGrid HorizonTexture::PlaceIn(const LocalFrame& anchor) const {
  if (!horizon_) return {};
  return PlaceOnGridOf(horizon_->map->grid(), horizon_->frame, anchor);
}

void HorizonTexture::Upload(double azimuth_rad) {
  const HeightRaster sines = horizon_->map->Towards(azimuth_rad);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  UploadTexture(GL_TEXTURE_2D, texture_,
                {GL_R32F, sines.columns, sines.rows, 1, GL_RED, GL_FLOAT, sines.z_m.data()});
  azimuth_rad_ = azimuth_rad;
}

void HorizonTexture::Bind(int unit, const Vector<Ecef>& to_light) {
  constexpr double kTurns_rad = 0.1 * kRadiansPerDegree;
  BindTexture(unit, GL_TEXTURE_2D, texture_);
  if (!horizon_) return;
  const glm::dvec3 direction = horizon_->frame.EnuFromEcef(to_light).xyz;
  const double azimuth_rad = std::atan2(direction.y, direction.x);
  if (!azimuth_rad_ ||
      std::abs(std::remainder(azimuth_rad - *azimuth_rad_, 2.0 * kPi)) > kTurns_rad)
    Upload(azimuth_rad);
}

namespace {

// Returns whether depth can run from 1 at the near plane to 0 at infinity. A float depth buffer
// then has a nearly constant relative precision.
bool CanReverseDepth() {
  return epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control");
}

ShaderPiece DefinesOf(const LandProgramKind& kind) {
  return {"kind of land",
          fmt::format("#define BENDS {:d}\n#define MOONLIT {:d}\n"
                      "#define FADES {:d}\n#define MOMENTARY_EDGES {:d}\n",
                      kind.bends, kind.moonlit, kind.fades, kind.has_momentary_edges)};
}

ShaderProgram LandProgram(const LandProgramKind& kind) {
  std::vector<VertexAttribute> attributes;
  for (const char* const name : LandPass::kAttributes)
    attributes.push_back({static_cast<GLuint>(attributes.size()), name});
  const char* const fragment = kind.drawn == LandDrawn::kSurface
                                   ? "viewer/shaders/land/land.frag.glsl"
                                   : "viewer/shaders/land/depth_prepass.frag.glsl";
  return ShaderProgram(
      WithViewerPieces(LandVertexTexts(kind), {"viewer/shaders/land/land.vert.glsl"}),
      WithViewerPieces(LandFragmentTexts(kind, LandPass::DepthText()), {fragment}), attributes);
}

glm::vec4 Padded(const glm::dvec3& v) { return {glm::vec3(v), 0.0F}; }

}  // namespace

LandBlock LandBlockOf(const LocalFrame& anchor, const Place& eye, double new_light) {
  const FrameTransform from_eye(anchor, LocalFrame(anchor.ellipsoid(), eye));
  const glm::vec3 high(from_eye.origin_m());
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  LandBlock block{};
  block.eye_high = glm::vec4(high, 0.0F);
  block.eye_low = Padded(from_eye.origin_m() - glm::dvec3(high));
  block.east = Padded(from_eye.axes()[0]);
  block.north = Padded(from_eye.axes()[1]);
  block.up = Padded(from_eye.axes()[2]);
  block.eye_above.y = static_cast<float>(new_light);
  block.pixel = {2.0F / static_cast<float>(viewport[2]), 2.0F / static_cast<float>(viewport[3]),
                 0.0F, 0.0F};
  return block;
}

LandPass::LandPass() : reversed_depth_(CanReverseDepth()) {}

const ShaderProgram& LandPass::ProgramOf(const LandProgramKind& kind) {
  const auto found = programs_.find(kind);
  if (found != programs_.end()) return found->second;
  return programs_.emplace(kind, LandProgram(kind)).first->second;
}

// The kinds that differ from the last one in one property. The triangle that each draws has no
// vertices and covers no pixel.
bool LandPass::MakeOneReady() {
  if (!last_kind_) return false;
  for (bool LandProgramKind::*const property :
       {&LandProgramKind::fades, &LandProgramKind::has_momentary_edges, &LandProgramKind::moonlit,
        &LandProgramKind::bends}) {
    LandProgramKind next = *last_kind_;
    next.*property = !(next.*property);
    if (next.has_momentary_edges && !horizon_.HasAny()) continue;
    if (programs_.count(next) > 0) continue;
    const ShaderProgram& program = ProgramOf(next);
    program.Use();
    if (next.has_momentary_edges) BindEdges(program);
    Draw(next, program, false, [&] {
      glBindVertexArray(no_vertices_.id());
      glDrawArrays(GL_TRIANGLES, 0, 3);
    });
    return true;
  }
  return false;
}

std::vector<ShaderPiece> LandVertexTexts(const LandProgramKind& kind) {
  std::vector<ShaderPiece> texts = SharedTexts();
  texts.push_back(DefinesOf(kind));
  return WithViewerPieces(std::move(texts), {"viewer/shaders/view/block.glsl",
                                             "viewer/shaders/view/refracted_rays.glsl",
                                             "viewer/shaders/land/block.glsl"});
}

std::vector<ShaderPiece> LandFragmentTexts(const LandProgramKind& kind, const ShaderPiece& depth) {
  std::vector<ShaderPiece> texts = WithViewerPieces(
      {DefinesOf(kind)},
      {"viewer/shaders/view/block.glsl", "viewer/shaders/land/block.glsl",
       "viewer/shaders/gbuffer/octahedral.glsl", "viewer/shaders/gbuffer/inverse_depth.glsl"});
  texts.push_back(depth);
  return WithViewerPieces(std::move(texts), {"viewer/shaders/land/seen.glsl"});
}

ShaderPiece LandPass::DepthText() {
  return ViewerPiece(CanReverseDepth() ? "viewer/shaders/gbuffer/reversed_depth.glsl"
                                       : "viewer/shaders/gbuffer/logarithmic_depth.glsl");
}

void LandPass::Clear(LandDrawn drawn) {
  constexpr std::array<float, 4> kNothing{};
  constexpr float kFarthest = 0.0F;
  glDepthMask(GL_TRUE);
  if (drawn == LandDrawn::kSurface) {
    glClearBufferfv(GL_COLOR, 0, kNothing.data());
    glClearBufferfv(GL_COLOR, 1, kNothing.data());
  }
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
}

void LandPass::BindEdges(const ShaderProgram& program) {
  constexpr int kUnit = 0;
  horizon_.Bind(kUnit, edges_.to_light);
  program.BindSampler("horizon_sines", kUnit);
}

// Returns how far the disk has risen since the shadow edges of the vertices were computed, in radii
// of the disk, for the old light and the new one, as seen from the anchor.
glm::vec4 LandPass::RisenSinceMade(const LocalFrame& anchor) const {
  const auto elevation = [&](const Vector<Ecef>& direction) {
    return std::asin(std::clamp(anchor.EnuFromEcef(direction).xyz.z, -1.0, 1.0));
  };
  const auto risen = [&](const std::optional<Vector<Ecef>>& then) {
    if (!then || !(edges_.radius_rad > 0.0)) return 0.0;
    return (elevation(edges_.to_light) - elevation(*then)) / edges_.radius_rad;
  };
  return glm::vec4(
      glm::dvec4(risen(edges_of_vertices_.from), risen(edges_of_vertices_.to), 0.0, 0.0));
}

// An outline has no light.
void LandPass::Run(LandDrawn drawn, const LandLook& look, LandBlock block, const LocalFrame& anchor,
                   GLuint view_binding, bool one_side, const std::function<void()>& draw) {
  const bool is_surface = drawn == LandDrawn::kSurface;
  const LandProgramKind kind{drawn, look.bends, is_surface && look.moonlit,
                             is_surface && block.eye_above.y < 1.0F,
                             is_surface && edges_.share > 0.0 && horizon_.HasAny()};
  if (is_surface) last_kind_ = kind;
  const ShaderProgram& program = ProgramOf(kind);
  block.eye_above.z = reversed_depth_ ? 1.0F : 0.0F;
  program.Use();
  block.risen = RisenSinceMade(anchor);
  if (kind.has_momentary_edges) {
    const PlaceOnGrid place = horizon_.PlaceIn(anchor);
    block.horizon_u = place.u;
    block.horizon_v = place.v;
    block.eye_above.w = static_cast<float>(edges_.share);
    BindEdges(program);
  }
  UploadBlock(block_, kLandBinding, block);
  view_binding_ = view_binding;
  Draw(kind, program, one_side, draw);
}

// Sets the state of the pipeline that belongs to a kind, and draws.
void LandPass::Draw(const LandProgramKind& kind, const ShaderProgram& program, bool one_side,
                    const std::function<void()>& draw) const {
  program.BindBlock("Land", kLandBinding);
  program.BindBlock("View", view_binding_);
  if (reversed_depth_) glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  if (one_side) glEnable(GL_CULL_FACE);
  const GLboolean writes_moon_sky = kind.moonlit ? GL_TRUE : GL_FALSE;
  glColorMaski(GBuffer::kMoonSky, writes_moon_sky, writes_moon_sky, writes_moon_sky,
               writes_moon_sky);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  draw();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glColorMaski(GBuffer::kMoonSky, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  if (reversed_depth_) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

}  // namespace alpenglow::viewer
