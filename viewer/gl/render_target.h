// SPDX-License-Identifier: MIT
// Pictures that are drawn into and read from, on the graphics card.
//
// Pixels on their way back from the graphics card, without waiting for it.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "lut/picture/image.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// What a pixel of a picture is made of; all of them can be drawn into by OpenGL 3.3.
enum class PixelFormat {
  kRgba32F,  // 16 bytes
  kRgba16F,  // 8 bytes: eleven bits, up to 65504
  kRgba8,    // 4 bytes, of [0, 1]: what a window has
};

/// Textures of one size that are drawn into together, on request with a depth buffer.
class RenderTarget {
 public:
  enum class Depth { kNone, k32Bit };
  /// One picture of kRgba32F.
  RenderTarget(int width, int height, Depth depth = Depth::kNone)
      : RenderTarget(width, height, {PixelFormat::kRgba32F}, depth) {}
  /// Contents are undefined until drawn; what texture units are bound to stays. Throws DisplayError
  /// when the graphics card has no memory for them.
  /// @param width, height >= 1.
  /// @param formats of the outputs of the fragment stage at locations 0, 1, ...: up to eight; none
  ///     where depth alone is wanted.
  RenderTarget(int width, int height, const std::vector<PixelFormat>& formats, Depth depth);

  /// Draws go here from now on, over the whole picture, into all outputs.
  void Bind() const;
  void BindTexture(int unit, std::size_t output = 0) const;
  /// Of one made with depth.
  void BindDepth(int unit) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }

  /// Draws are tested against the depth of another target, of the same size, from now on.
  void UseDepthOf(const RenderTarget& other) const;

  /// Puts red, green and blue into the first output, row 0 at the top; another size than the
  /// target's is an error.
  void Write(const Image& image) const;

  // What was drawn, row 0 at the top. Each waits until it is drawn.
  /// Red, green and blue.
  [[nodiscard]] Image Read() const;
  [[nodiscard]] std::vector<glm::vec4> ReadValues(std::size_t output = 0) const;
  /// Red, green and blue of a developed picture, a byte each.
  [[nodiscard]] DisplayImage ReadBytes() const;

 private:
  template <typename Pixel>
  void ReadInto(std::vector<Pixel>& pixels, std::size_t output, GLenum format) const;

  int width_, height_;
  std::vector<GlTexture> colours_;
  GlTexture depth_;
  GlFramebuffer framebuffer_;
};

/// Makes a target anew when it is missing or of another size.
template <typename Target>
void Fit(std::optional<Target>& target, int width, int height) {
  if (target && target->width() == width && target->height() == height) return;
  target.emplace(width, height);
}

/// Makes a target of one output anew when it is missing or of another size.
inline void Fit(std::optional<RenderTarget>& target, int width, int height, PixelFormat format) {
  if (target && target->width() == width && target->height() == height) return;
  target.emplace(width, height, std::vector{format}, RenderTarget::Depth::kNone);
}

/// Filtering of a bound texture: linear or none, clamped at the edges.
void ClampAndFilter(GLenum target, bool linear);

/// Reads one rectangle after the other. An OpenGL context must be current in all calls.
class PixelReader {
 public:
  /// Of a picture [pixels], row 0 at the bottom as OpenGL has it.
  struct Rectangle {
    int left, bottom, width, height;
  };

  PixelReader() = default;
  ~PixelReader();
  PixelReader(const PixelReader&) = delete;
  PixelReader& operator=(const PixelReader&) = delete;

  /// Begins to read red, green and blue of the first output; nothing while Busy().
  void Begin(const RenderTarget& picture, const Rectangle& part);
  /// Gives up what was begun.
  void Forget();
  /// Whether what was begun is not taken yet.
  [[nodiscard]] bool Busy() const { return arrives_ != nullptr; }
  /// What was begun, once it has arrived: most often a frame or two later.
  [[nodiscard]] std::optional<std::vector<std::array<float, 3>>> Take();

 private:
  GlBuffer buffer_;
  std::size_t pixels_ = 0;
  GLsync arrives_ = nullptr;
};

}  // namespace alpenglow::viewer
