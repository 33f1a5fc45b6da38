// SPDX-License-Identifier: MIT
#include "viewer/shade/shaft_pass.h"

#include "atmosphere/text/error.h"
#include "viewer/gl/gl_context.h"
#include "viewer/shaders/full_screen.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow {
namespace {

std::vector<ShaderPiece> PassTexts(std::vector<ShaderPiece> air) {
  return WithViewerPieces(std::move(air),
                          {"viewer/shaders/shade_march.glsl", "viewer/shaders/shaft_texel.glsl",
                           "viewer/shaders/shafts.frag.glsl"});
}

}  // namespace

std::vector<ShaderPiece> ShaftTexts() {
  return WithViewerPieces({}, {"viewer/shaders/shaft_texel.glsl", "viewer/shaders/shafts.glsl"});
}

ShaftPass::ShaftPass(std::vector<ShaderPiece> air)
    : program_(FullScreenProgram(PassTexts(std::move(air)))) {}

void ShaftPass::Paint(const ShadeTexture& shade, const glm::dmat4& map_from_eye, int width,
                      int height, int surface_unit, int shade_unit, const ShaftDetail& detail) {
  ALPENGLOW_ENSURE(detail.scale, >=, 1);
  scale_ = detail.scale;
  const auto part = [&](int side) { return (side + scale_ - 1) / scale_; };
  Fit(map_, part(width), part(height));
  map_->Bind();
  program_.Use();
  shade.Bind(program_, shade_unit, map_from_eye, detail.steps);
  glUniform1i(program_.Uniform("surface_map"), surface_unit);
  glUniform2i(program_.Uniform("picture_size"), width, height);
  glUniform1i(program_.Uniform("shaft_scale"), scale_);
  DrawFullScreen(program_, no_vertices_);
  CheckGl("ShaftPass::Paint");
}

void ShaftPass::Bind(const ShaderProgram& picture, int unit) const {
  ALPENGLOW_ENSURE(map_.has_value(), ==, true);
  map_->BindTexture(unit);
  picture.Use();
  glUniform1i(picture.Uniform("shaft_map"), unit);
  const float step = 1.0F / static_cast<float>(scale_);
  const float first = 0.5F + static_cast<float>(scale_ / 2);  // pixel that has the first ray
  glUniform2f(picture.Uniform("shaft_place"), step, -first * step);
}

}  // namespace alpenglow
