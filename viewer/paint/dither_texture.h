// SPDX-License-Identifier: MIT
// The tile of dither noise on the graphics card, for shaders/dither_tile.glsl.
#pragma once

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

/// DitherNoise (lut/picture/dither.h), four floats a pixel.
class DitherTexture {
 public:
  DitherTexture();

  /// Tells a program, in use, the unit and the size [pixels] of what it fills.
  void Bind(const ShaderProgram& program, int unit, int width, int height) const;

 private:
  GlTexture noise_;
};

}  // namespace alpenglow::viewer
