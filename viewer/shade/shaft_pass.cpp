// SPDX-License-Identifier: MIT
#include "viewer/shade/shaft_pass.h"

#include <fmt/format.h>

#include "atmosphere/text/error.h"
#include "viewer/gl/gl_context.h"
#include "viewer/shaders/full_screen.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {

std::vector<ShaderPiece> ShaftPassTexts(std::vector<ShaderPiece> air, bool has_fog) {
  air.push_back(
      {"fog of shafts",
       fmt::format("#define HAS_FOG {}\n#define LEFT_BY_FOG(direction, km) {}\n", has_fog ? 1 : 0,
                   has_fog ? "FogTransmittance(direction, min(km, kOutOfFog_km))" : "1.0")});
  std::vector<std::string> files{"viewer/shaders/shade_march.glsl",
                                 "viewer/shaders/shaft_texel.glsl"};
  if (has_fog) files.emplace_back("viewer/shaders/fog_shade.glsl");
  return WithViewerPieces(std::move(air), files);
}

std::vector<ShaderPiece> ShaftTexts() {
  return WithViewerPieces({}, {"viewer/shaders/shaft_texel.glsl", "viewer/shaders/shafts.glsl"});
}

ShaftPass::ShaftPass(std::vector<ShaderPiece> air, bool has_fog)
    : has_fog_(has_fog),
      program_(FullScreenProgram(WithViewerPieces(ShaftPassTexts(std::move(air), has_fog),
                                                  {"viewer/shaders/shafts.frag.glsl"}))) {}

void ShaftPass::Paint(const ShadeTexture& shade, const glm::dmat4& map_from_eye, int width,
                      int height, int surface_unit, int shade_unit, const ShaftDetail& detail) {
  ALPENGLOW_ENSURE(detail.scale, >=, 1);
  scale_ = detail.scale;
  const auto part = [&](int side) { return (side + scale_ - 1) / scale_; };
  if (!map_ || map_->width() != part(width) || map_->height() != part(height)) {
    const std::vector<PixelFormat> maps(has_fog_ ? 2 : 1, PixelFormat::kRgba32F);
    map_.emplace(part(width), part(height), maps, RenderTarget::Depth::kNone);
  }
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
  if (has_fog_) map_->BindTexture(unit + 1, 1);
  picture.Use();
  glUniform1i(picture.Uniform("shaft_map"), unit);
  glUniform1i(picture.Uniform("fog_shaft_map"), unit + 1);
  const float step = 1.0F / static_cast<float>(scale_);
  const float first = 0.5F + static_cast<float>(scale_ / 2);  // pixel that has the first ray
  glUniform2f(picture.Uniform("shaft_place"), step, -first * step);
}

}  // namespace alpenglow::viewer
