// SPDX-License-Identifier: MIT
// Linear pictures made to look at, on the graphics card.
#pragma once

#include "lut/picture/image.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"

namespace alpenglow {

/// Exposure, gamut, tone curve and dither, as Develop (image.h) does them.
class Developer {
 public:
  explicit Developer(ToneCurve curve);

  /// Takes another curve; nothing if it is the one in use.
  void Use(ToneCurve curve);
  [[nodiscard]] ToneCurve curve() const { return curve_; }

  /// Where a developed picture goes: a framebuffer (0: the window) and its size [pixels].
  struct Screen {
    GLuint framebuffer;
    int width, height;
  };
  /// Fills the screen; a picture of another size is scaled, bilinearly.
  void Develop(const RenderTarget& picture, double ev100, const Screen& screen) const;

 private:
  ToneCurve curve_;
  ShaderProgram program_;
  GlVertexArray no_vertices_;
  GlTexture table_, dither_noise_;
};

}  // namespace alpenglow
