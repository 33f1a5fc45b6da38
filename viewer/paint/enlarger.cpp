// SPDX-License-Identifier: MIT
#include "viewer/paint/enlarger.h"

#include <utility>
#include <vector>

#include "viewer/gl/gl_context.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

enum EnlargerUnit { kSmall, kPrintDither, kOutline };

ShaderProgram ProgramOf(Enlarger::Shows shows) {
  ShaderProgram program = FullScreenProgram(WithViewerPieces(
      EnlargerTexts(shows, LandPass::DepthText()), {"viewer/shaders/enlarge.frag.glsl"}));
  program.BindSampler("small_picture", kSmall);
  program.BindSampler("outline", kOutline);
  return program;
}

}  // namespace

std::vector<ShaderPiece> EnlargerTexts(Enlarger::Shows shows, const ShaderPiece& depth) {
  const bool dithers = shows == Enlarger::Shows::kCodes;
  std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/nearness.glsl"});
  texts.push_back(depth);
  texts.push_back({"shown", dithers ? "#define DITHERS 1\n" : "#define DITHERS 0\n"});
  return dithers ? WithViewerPieces(std::move(texts), {"viewer/shaders/dither_tile.glsl"}) : texts;
}

Enlarger::Enlarger(Shows shows) : shows_(shows), program_(ProgramOf(shows)) {}

void Enlarger::Enlarge(const RenderTarget& small, const LandOutline& outline,
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
  CheckGl("Enlarger::Enlarge");
}

}  // namespace alpenglow::viewer
