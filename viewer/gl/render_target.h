// SPDX-License-Identifier: MIT
// Pictures that are drawn into and read from, on the graphics card.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "lut/picture/image.h"
#include "viewer/gl/gl_objects.h"

namespace alpenglow {

/// What a pixel of a picture is made of; all of them can be drawn into by OpenGL 3.3.
enum class PixelFormat {
  kRgba32F,    // 16 bytes
  kRgba16F,    // 8 bytes: eleven bits, up to 65504
  kR11G11B10,  // 4 bytes: six and five bits, none negative
  kRgba8,      // 4 bytes: [0, 1]
};
[[nodiscard]] int BytesOf(PixelFormat format);

/// Textures of one size that are drawn into together, on request with a depth buffer.
class RenderTarget {
 public:
  enum class Depth { kNone, k32Bit };
  /// One picture of kRgba32F.
  RenderTarget(int width, int height, Depth depth)
      : RenderTarget(width, height, {PixelFormat::kRgba32F}, depth) {}
  /// Contents are undefined until drawn. @param width, height >= 1. @param formats of the outputs of
  /// the fragment stage at locations 0, 1, ...: one to eight. Throws DisplayError when the graphics
  /// card has no memory for them.
  RenderTarget(int width, int height, const std::vector<PixelFormat>& formats, Depth depth);

  /// Draws go here from now on, over the whole picture, into all outputs.
  void Bind() const;
  void BindTexture(int unit, std::size_t output = 0) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }

  /// Draws are tested against this depth texture of the same size from now on.
  void UseDepth(GLuint texture) const;

  /// Puts red, green and blue into the first output, row 0 at the top; another size than the
  /// target's is an error.
  void Write(const Image& image) const;

  // What was drawn, row 0 at the top. Each waits until it is drawn.
  /// Red, green and blue.
  [[nodiscard]] Image Read(std::size_t output = 0) const;
  [[nodiscard]] std::vector<glm::vec4> ReadValues(std::size_t output = 0) const;
  /// Bits of half floats (IEEE 754 binary16).
  [[nodiscard]] std::vector<std::array<std::uint16_t, 4>> ReadHalves(std::size_t output = 0) const;
  /// Red, green and blue of a developed picture, a byte each.
  [[nodiscard]] DisplayImage ReadBytes(std::size_t output = 0) const;

 private:
  template <typename Pixel>
  void ReadInto(std::vector<Pixel>& pixels, std::size_t output, GLenum format, GLenum type) const;

  int width_, height_;
  std::vector<GlTexture> colours_;
  GlTexture depth_;
  GlFramebuffer framebuffer_;
};

/// Filtering of a bound texture: linear or none, clamped at the edges.
void ClampAndFilter(GLenum target, bool linear);

/// Of the framebuffer that is drawn into (0: the window), row 0 at the top.
[[nodiscard]] DisplayImage ReadFramebuffer(GLuint framebuffer, int width, int height);

}  // namespace alpenglow
