// SPDX-License-Identifier: MIT
// Pictures painted smaller than the screen, on the screen: smooth where they are smooth, with the
// edges of land where the screen has them (shaders/enlarge.frag.glsl).
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/land_outline.h"
#include "viewer/paint/dither_texture.h"
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

}  // namespace alpenglow::viewer
