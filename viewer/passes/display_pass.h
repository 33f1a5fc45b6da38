// SPDX-License-Identifier: MIT
// Display of rendered pictures on a screen, which may be larger than the picture.
//
// If the picture is smaller than the screen, it is tone-mapped at its own resolution and then
// upscaled by Upscaler, which interpolates smooth areas and uses the edges of land at screen
// resolution (shaders/display.glsl). The cost of lighting is that of the small picture, and
// edges stay sharp.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/land_pass.h"
#include "viewer/passes/painted_view.h"
#include "viewer/passes/tone_map_pass.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

class Upscaler {
 public:
  enum class Shows {
    kCodes,  // display codes, dithered to bytes
    kLight   // linear light, for comparisons
  };
  explicit Upscaler(Shows shows);

  /// Fills the framebuffer (0: the window), which has the size of the outline.
  /// @param small      of any size, with the inverse depth of land (shaders/gbuffer.glsl) in
  ///   its fourth component.
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

/// Returns the shader texts that display.upscale.frag.glsl is built from.
/// @param depth  text of a depth mode: LandPass::DepthText, or the other one.
[[nodiscard]] std::vector<ShaderPiece> UpscalerTexts(Upscaler::Shows shows,
                                                     const ShaderPiece& depth);

/// Shows pictures of linear light on a screen, whole or upscaled. Bodies, which are disks and
/// stars, are not upscaled: they are added to linear light at screen resolution and developed
/// there.
class DisplayPass {
 public:
  explicit DisplayPass(const Look& look,
                       ToneMapPass::FirstPictures first = ToneMapPass::FirstPictures::kWait)
      : tone_map_(look, first) {}

  [[nodiscard]] ToneMapPass& tone_map() { return tone_map_; }

  /// Returns whether a view is upscaled on this screen. Its picture must then be rendered without
  /// bodies.
  [[nodiscard]] static bool Upscales(const PaintedView& view, const ToneMapPass::Screen& screen) {
    return view.width < screen.width || view.height < screen.height;
  }

  /// Returns the outline of land at screen resolution, for the caller to draw before ShowUpscaled.
  [[nodiscard]] const DepthPrepass& OutlineFor(const ToneMapPass::Screen& screen);
  /// Shows a picture upscaled along the outline.
  /// @param half_view  tangents of half the horizontal and half the vertical field of view.
  /// @param timer      receives the times of the passes; null: none.
  void ShowUpscaled(const RenderTarget& picture, const glm::dvec2& half_view, double ev100,
                    const ToneMapPass::Screen& screen, PassTimer* timer);
  /// Returns the linear light of a picture, upscaled to the screen in some boxes of pixels, for the
  /// caller to add bodies before ShowBodies.
  [[nodiscard]] const RenderTarget& LightIn(const std::vector<PixelBox>& boxes,
                                            const RenderTarget& picture,
                                            const glm::dvec2& half_view,
                                            const ToneMapPass::Screen& screen);
  /// Shows these boxes. Edges of bodies differ from those of land, so the light around them is
  /// upscaled before it is tone-mapped.
  void ShowBodies(double ev100, const ToneMapPass::Screen& screen) const {
    tone_map_.Develop(*light_, ev100, screen, bodies_);
  }

 private:
  ToneMapPass tone_map_;
  Upscaler code_upscaler_{Upscaler::Shows::kCodes}, light_upscaler_{Upscaler::Shows::kLight};
  std::optional<RenderTarget> codes_, light_;  // at picture size; at screen size
  std::optional<DepthPrepass> outline_;
  PassArea bodies_;
};

}  // namespace alpenglow::viewer
