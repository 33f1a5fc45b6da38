// SPDX-License-Identifier: MIT
#include "viewer/passes/display_pass.h"

#include <utility>
#include <vector>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

enum UpscalerUnit { kSmall, kPrintDither, kOutline };

ShaderProgram ProgramOf(Upscaler::Shows shows) {
  ShaderProgram program = FullScreenProgram(WithViewerPieces(
      UpscalerTexts(shows, LandPass::DepthText()), {"viewer/shaders/display.upscale.frag.glsl"}));
  program.BindSampler("small_picture", kSmall);
  program.BindSampler("outline", kOutline);
  return program;
}

}  // namespace

std::vector<ShaderPiece> UpscalerTexts(Upscaler::Shows shows, const ShaderPiece& depth) {
  const bool dithers = shows == Upscaler::Shows::kCodes;
  std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/gbuffer.inverse_depth.glsl"});
  texts.push_back(depth);
  texts.push_back({"shown", dithers ? "#define DITHERS 1\n" : "#define DITHERS 0\n"});
  return dithers ? WithViewerPieces(std::move(texts), {"viewer/shaders/display.dither.glsl"})
                 : texts;
}

Upscaler::Upscaler(Shows shows) : shows_(shows), program_(ProgramOf(shows)) {}

void Upscaler::Upscale(const RenderTarget& small, const DepthPrepass& outline,
                       const glm::dvec2& half_view, GLuint framebuffer,
                       const PassArea& area) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, outline.width(), outline.height());
  small.BindTexture(kSmall);
  outline.BindDepth(kOutline);
  program_.Use();
  if (shows_ == Shows::kCodes)
    dither_.Bind(program_, kPrintDither, outline.width(), outline.height());
  glUniform2f(program_.Uniform("half_view"), static_cast<float>(half_view.x),
              static_cast<float>(half_view.y));
  area.Draw(program_);
  CheckGl("Upscaler::Enlarge");
}

const DepthPrepass& DisplayPass::OutlineFor(const ToneMapPass::Screen& screen) {
  Fit(outline_, screen.width, screen.height);
  return *outline_;
}

void DisplayPass::ShowUpscaled(const RenderTarget& picture, const glm::dvec2& half_view,
                               double ev100, const ToneMapPass::Screen& screen, PassTimer* timer) {
  {
    const TimedPass timed(timer, "tone_map");
    Fit(codes_, picture.width(), picture.height(), PixelFormat::kRgba16F);
    tone_map_.DevelopSmall(picture, ev100, *codes_);
  }
  const TimedPass timed(timer, "upscale");
  code_upscaler_.Upscale(*codes_, *outline_, half_view, screen.framebuffer);
}

const RenderTarget& DisplayPass::LightIn(const std::vector<PixelBox>& boxes,
                                         const RenderTarget& picture, const glm::dvec2& half_view,
                                         const ToneMapPass::Screen& screen) {
  Fit(light_, screen.width, screen.height, PixelFormat::kRgba32F);
  bodies_.Set(boxes, screen.width, screen.height);
  light_upscaler_.Upscale(picture, *outline_, half_view, light_->framebuffer(), bodies_);
  return *light_;
}

}  // namespace alpenglow::viewer
