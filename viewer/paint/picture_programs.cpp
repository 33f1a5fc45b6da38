// SPDX-License-Identifier: MIT
#include "viewer/paint/picture_programs.h"

#include <utility>

#include "viewer/gl/scissor.h"
#include "viewer/paint/picture_units.h"
#include "viewer/shaders/full_screen.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

// Fragments of depth 0 against that of the land: it is nearer, or there is none.
GLenum DepthTestOf(PictureStage::Pass pass) {
  if (pass == PictureStage::Pass::kNight) return GL_ALWAYS;
  return pass == PictureStage::Pass::kLand ? GL_LESS : GL_EQUAL;
}

void ConnectBlocks(const ShaderProgram& program) {
  program.BindBlock("Air", kAirBinding);
  program.BindBlock("View", kViewBinding);
  program.BindBlock("Ground", kGroundBinding);
  program.BindBlock("GroundLight", kGroundLightBinding);
  program.BindBlock("GroundSurface", kGroundSurfaceBinding);
  program.BindBlock("SkyByPixel", kSkyByPixelBinding);
}

void ConnectMaps(const ShaderProgram& program) {
  program.BindSampler("surface_map", kSurfaceUnit);
  program.BindSampler("sky_on_surface", kSkyOnSurfaceUnit);
  program.BindSampler("shaft_map", kShaftUnit);
  program.BindSampler("fog_shaft_map", kFogShaftUnit);
}

}  // namespace

PicturePrograms::PicturePrograms(const PaintedScene& scene, const LampPainter& lamps,
                                 const ShaftPass& shafts)
    : scene_(scene), lamps_(lamps), shafts_(shafts) {}

ShaderProgram PicturePrograms::Made(const PictureStage& stage) const {
  const PictureKind kind{scene_.material(), lamps_, scene_.land_kind(), scene_.fog_phase()};
  ShaderProgram made = FullScreenProgram(
      WithViewerPieces(PictureTexts(kind, stage), {"viewer/shaders/picture.frag.glsl"}));
  ConnectBlocks(made);
  ConnectMaps(made);
  AirTextures::Prepare(made, kAirUnit, kTablesBinding);
  if (stage.has_lamps) lamps_.Connect(made);
  if (scene_.fog() != nullptr) scene_.fog()->Connect(made);
  return made;
}

const ShaderProgram& PicturePrograms::Of(const PictureStage& stage) {
  const auto found = made_.find(stage);
  if (found != made_.end()) return found->second;
  return made_.emplace(stage, Made(stage)).first->second;
}

void PicturePrograms::Paint(const PictureStage& stage, LightSource source) {
  const ShaderProgram& program = Of(stage);
  scene_.ground_textures().Bind(program, kGroundUnit, source);
  if (stage.sky_by_pixel) scene_.sky_by_pixel(source)->Bind(program, kSkyByPixelUnit, source);
  if (stage.has_shade) shafts_.Bind(program, kShaftUnit);
  program.Use();
  glDepthFunc(DepthTestOf(stage.pass));
  DrawFullScreen(program, no_vertices_);
  ready_.insert(stage);
}

bool PicturePrograms::MakeReady(const PictureStage& stage) {
  if (ready_.contains(stage) || (stage.has_shade && !shafts_.HasMap())) return false;
  const Scissor one_pixel({0, 0, 1, 1});
  Paint(stage);
  return true;
}

void PicturePrograms::ForgetThoseWithLamps() {
  std::erase_if(made_, [](const auto& made) { return made.first.has_lamps; });
  std::erase_if(ready_, [](const PictureStage& stage) { return stage.has_lamps; });
}

}  // namespace alpenglow::viewer
