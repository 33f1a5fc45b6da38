// SPDX-License-Identifier: MIT
// Linear pictures made to look at, on the graphics card.
#pragma once

#include <vector>

#include "lut/picture/image.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/paint/dither_texture.h"

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
  /// Codes in [0, 1], not dithered, for an Enlarger: into a target of the picture's size, whose
  /// fourth component it gets too.
  void DevelopSmall(const RenderTarget& picture, double ev100, const RenderTarget& codes) const;

 private:
  void Fill(const ShaderProgram& program, const RenderTarget& picture, double ev100,
            const Screen& screen) const;

  ToneCurve curve_;
  ShaderProgram program_, small_program_;
  GlVertexArray no_vertices_;
  GlTexture table_;
  DitherTexture dither_;
};

/// What develop.frag.glsl is put together with.
[[nodiscard]] std::vector<ShaderPiece> DeveloperTexts(ToneCurve curve, bool dithers);

}  // namespace alpenglow
