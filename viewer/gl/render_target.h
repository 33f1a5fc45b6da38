// SPDX-License-Identifier: MIT
// Pictures that are drawn into and read from: floats on the graphics card.
#pragma once

#include "lut/picture/image.h"
#include "viewer/gl/gl_objects.h"

namespace alpenglow {

/// A texture of four floats a pixel that can be drawn into, on request with a depth buffer.
class RenderTarget {
 public:
  enum class Depth { kNone, k32Bit };
  /// Contents are undefined until drawn. @param width, height >= 1.
  RenderTarget(int width, int height, Depth depth);

  /// Draws go here from now on, over the whole picture.
  void Bind() const;
  void BindTexture(int unit) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }

  /// Puts red, green and blue there, row 0 at the top; another size than the target's is an error.
  void Write(const Image& image) const;
  /// Red, green and blue, row 0 at the top.
  [[nodiscard]] Image Read() const;

 private:
  int width_, height_;
  GlTexture colour_, depth_;
  GlFramebuffer framebuffer_;
};

/// Filtering of a bound texture: linear or none, clamped at the edges.
void ClampAndFilter(GLenum target, bool linear);

}  // namespace alpenglow
