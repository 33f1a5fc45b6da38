// SPDX-License-Identifier: MIT
#include "viewer/passes/display_pass.h"

#include <utility>
#include <vector>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {
namespace {

enum UpscalerUnit { kSmall, kPrintDither, kOutline };

ShaderProgram ProgramOf(Upscaler::Shows shows) {
  ShaderProgram program = FullScreenProgram(WithViewerPieces(
      UpscalerTexts(shows, LandPass::DepthText()), {"viewer/shaders/upscale.frag.glsl"}));
  program.BindSampler("small_picture", kSmall);
  program.BindSampler("outline", kOutline);
  return program;
}

}  // namespace

std::vector<ShaderPiece> UpscalerTexts(Upscaler::Shows shows, const ShaderPiece& depth) {
  const bool dithers = shows == Upscaler::Shows::kCodes;
  std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/inverse_depth.glsl"});
  texts.push_back(depth);
  texts.push_back({"shown", dithers ? "#define DITHERS 1\n" : "#define DITHERS 0\n"});
  return dithers ? WithViewerPieces(std::move(texts), {"viewer/shaders/dither_tile.glsl"}) : texts;
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

namespace {

PaintedView OnScreen(const PaintedView& view, const ToneMapPass::Screen& screen) {
  return {view.eye, view.now, screen.width, screen.height, view.part};
}

}  // namespace

void DisplayPass::DrawUpscaled(SkyPainter& painter, const PaintedView& view, double ev100,
                               const ToneMapPass::Screen& screen) {
  Fit(outline_, screen.width, screen.height);
  painter.PaintOutline(*outline_);
  painter.Time("develop");
  const RenderTarget& picture = painter.picture();
  Fit(codes_, picture.width(), picture.height(), PixelFormat::kRgba16F);
  developer_.DevelopSmall(picture, ev100, *codes_);
  painter.Time("enlarge");
  code_enlarger_.Upscale(*codes_, *outline_, HalfViewOf(view), screen.framebuffer);
}

// Draws disks and stars. Their edges differ from those of land, so around them the linear light is
// upscaled before it is tone-mapped.
void DisplayPass::PrintBodies(SkyPainter& painter, const PaintedView& view, double ev100,
                              const ToneMapPass::Screen& screen,
                              const std::vector<PixelBox>& boxes) {
  if (boxes.empty()) return;
  painter.Time("bodies");
  Fit(light_, screen.width, screen.height, PixelFormat::kRgba32F);
  bodies_.Set(boxes, screen.width, screen.height);
  light_enlarger_.Upscale(painter.picture(), *outline_, HalfViewOf(view), light_->framebuffer(),
                          bodies_);
  painter.PaintBodiesOver(*light_, *outline_, OnScreen(view, screen));
  developer_.Develop(*light_, ev100, screen, bodies_);
}

// Drivers finish compiling a program on its first draw, which takes tenths of a second. The
// programs are therefore drawn once in the second and third frame, over one pixel that is
// overwritten afterwards, instead of when the picture is first reduced.
void DisplayPass::MakeReady(SkyPainter& painter, const PaintedView& view, double ev100,
                            const ToneMapPass::Screen& screen) {
  constexpr PixelBox kOnePixel{0, 0, 1, 1};
  if (prints_ == 2) {
    const Scissor within(kOnePixel);
    DrawUpscaled(painter, view, ev100, screen);
  }
  if (prints_ == 3) PrintBodies(painter, view, ev100, screen, {kOnePixel});
}

void DisplayPass::Print(SkyPainter& painter, const PaintedView& view, double ev100,
                        const ToneMapPass::Screen& screen) {
  ++prints_;
  MakeReady(painter, view, ev100, screen);
  if (Upscales(view, screen)) {
    DrawUpscaled(painter, view, ev100, screen);
    PrintBodies(painter, view, ev100, screen, painter.BodiesSeen(OnScreen(view, screen)));
  } else {
    painter.Time("develop");
    developer_.Develop(painter.picture(), ev100, screen);
  }
  painter.EndTime();
}

}  // namespace alpenglow::viewer
