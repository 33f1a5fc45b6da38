// SPDX-License-Identifier: MIT
// Display of rendered pictures on a screen, which may be larger than the picture.
//
// DisplayPass shows the picture that a SkyPainter rendered. If the picture is smaller than the screen,
// it is tone-mapped at its own resolution and then upscaled by Upscaler, which interpolates smooth
// areas and uses the edges of land at screen resolution (shaders/upscale.frag.glsl). The cost of
// lighting is that of the small picture, and edges stay sharp.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/land_pass.h"
#include "viewer/passes/sky_painter.h"
#include "viewer/passes/tone_map_pass.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {

class Upscaler {
 public:
  enum class Shows {
    kCodes,  // display codes, dithered to bytes
    kLight   // linear light, for comparisons
  };
  explicit Upscaler(Shows shows);

  /// Fills the framebuffer (0: the window), which has the size of the outline.
  /// @param small      of any size, with the inverse depth of land (shaders/inverse_depth.glsl) in its
  ///   fourth component.
  /// @param half_view  tangents of half the horizontal and half the vertical field of view.
  void Upscale(const RenderTarget& small, const DepthPrepass& outline, const glm::dvec2& half_view,
               GLuint framebuffer) const {
    Upscale(small, outline, half_view, framebuffer, whole_);
  }
  /// Fills only the pixels of an area.
  void Upscale(const RenderTarget& small, const DepthPrepass& outline, const glm::dvec2& half_view,
               GLuint framebuffer, const PassArea& area) const;

 private:
  Shows shows_;
  ShaderProgram program_;
  PassArea whole_;
  DitherTexture dither_;
};

/// Returns the shader texts that upscale.frag.glsl is built from.
/// @param depth  text of a depth mode: LandPass::DepthText, or the other one.
[[nodiscard]] std::vector<ShaderPiece> UpscalerTexts(Upscaler::Shows shows,
                                                     const ShaderPiece& depth);

class DisplayPass {
 public:
  explicit DisplayPass(const Look& look,
                       ToneMapPass::FirstPictures first = ToneMapPass::FirstPictures::kWait)
      : developer_(look, first) {}

  [[nodiscard]] ToneMapPass& developer() { return developer_; }
  [[nodiscard]] const ToneMapPass& developer() const { return developer_; }

  /// Returns whether a view is upscaled on this screen. Its picture must then be rendered without
  /// disks and stars, which are added at screen resolution.
  [[nodiscard]] static bool Upscales(const PaintedView& view, const ToneMapPass::Screen& screen) {
    return view.width < screen.width || view.height < screen.height;
  }
  /// Shows the most recent picture, which must be of this view.
  void Print(SkyPainter& painter, const PaintedView& view, double ev100,
             const ToneMapPass::Screen& screen);

 private:
  void DrawUpscaled(SkyPainter& painter, const PaintedView& view, double ev100,
                    const ToneMapPass::Screen& screen);
  void PrintBodies(SkyPainter& painter, const PaintedView& view, double ev100,
                   const ToneMapPass::Screen& screen, const std::vector<PixelBox>& boxes);
  void MakeReady(SkyPainter& painter, const PaintedView& view, double ev100,
                 const ToneMapPass::Screen& screen);

  ToneMapPass developer_;
  Upscaler code_enlarger_{Upscaler::Shows::kCodes}, light_enlarger_{Upscaler::Shows::kLight};
  std::optional<RenderTarget> codes_, light_;  // at picture size; at screen size
  std::optional<DepthPrepass> outline_;
  PassArea bodies_;
  int prints_ = 0;
};

}  // namespace alpenglow::viewer
