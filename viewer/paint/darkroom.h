// SPDX-License-Identifier: MIT
// Pictures painted smaller than the screen, on the screen: smooth where they are smooth, with the
// edges of land where the screen has them (shaders/enlarge.frag.glsl).
//
// From what a SkyPainter painted to what a screen shows. A picture smaller than the screen is
// developed as small as it is and enlarged by the edges that land has on the screen: light costs by
// what is painted, edges do not suffer.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/land_pass.h"
#include "viewer/paint/developer.h"
#include "viewer/paint/sky_painter.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {

class Enlarger {
 public:
  enum class Shows {
    kCodes,  // of a display: dithered to bytes
    kLight   // linear light, for comparisons
  };
  explicit Enlarger(Shows shows);

  /// Fills the framebuffer (0: the window), which has the outline's size.
  /// @param small  with nearness of land (shaders/nearness.glsl) in its fourth component; of any
  ///     size.
  /// @param half_view  tangents of half the width and half the height of the view.
  void Enlarge(const RenderTarget& small, const LandOutline& outline, const glm::dvec2& half_view,
               GLuint framebuffer) const {
    Enlarge(small, outline, half_view, framebuffer, whole_);
  }
  /// The pixels of an area alone.
  void Enlarge(const RenderTarget& small, const LandOutline& outline, const glm::dvec2& half_view,
               GLuint framebuffer, const PassArea& area) const;

 private:
  Shows shows_;
  ShaderProgram program_;
  PassArea whole_;
  DitherTexture dither_;
};

/// What enlarge.frag.glsl is put together with.
/// @param depth  LandPass::DepthText, or the other.
[[nodiscard]] std::vector<ShaderPiece> EnlargerTexts(Enlarger::Shows shows,
                                                     const ShaderPiece& depth);

class Darkroom {
 public:
  explicit Darkroom(const Look& look,
                    Developer::FirstPictures first = Developer::FirstPictures::kWait)
      : developer_(look, first) {}

  [[nodiscard]] Developer& developer() { return developer_; }
  [[nodiscard]] const Developer& developer() const { return developer_; }

  /// Whether a view will be enlarged on a screen, with disks and stars as sharp as that: its picture is
  /// to be painted without them.
  [[nodiscard]] static bool Enlarges(const PaintedView& view, const Developer::Screen& screen) {
    return view.width < screen.width || view.height < screen.height;
  }
  /// Shows the picture that was painted last, of this view.
  void Print(SkyPainter& painter, const PaintedView& view, double ev100,
             const Developer::Screen& screen);

 private:
  void PrintEnlarged(SkyPainter& painter, const PaintedView& view, double ev100,
                     const Developer::Screen& screen);
  void PrintBodies(SkyPainter& painter, const PaintedView& view, double ev100,
                   const Developer::Screen& screen, const std::vector<PixelBox>& boxes);
  void MakeReady(SkyPainter& painter, const PaintedView& view, double ev100,
                 const Developer::Screen& screen);

  Developer developer_;
  Enlarger code_enlarger_{Enlarger::Shows::kCodes}, light_enlarger_{Enlarger::Shows::kLight};
  std::optional<RenderTarget> codes_, light_;  // of the picture's size; of the screen's
  std::optional<LandOutline> outline_;
  PassArea bodies_;
  int prints_ = 0;
};

}  // namespace alpenglow::viewer
