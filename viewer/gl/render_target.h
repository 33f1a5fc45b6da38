// SPDX-License-Identifier: MIT
// Provides RenderTarget, a picture on the GPU that is drawn into and read; PixelReader, which reads
// pixels back from the GPU without waiting; and TiledPicture, a picture that is larger than the GPU
// can draw. Each tile is a part of the view.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "lut/image/image.h"
#include "viewer/gl/gl_context.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Format of a pixel. OpenGL 3.3 can draw into all of them.
enum class PixelFormat {
  kRgba32F,  // 16 bytes
  kRgba16F,  // 8 bytes: eleven bits of precision, up to 65504
  kRgba8,    // 4 bytes, values in [0, 1]: the format of a window
};

/// Textures of one size as the outputs of draw calls, with an optional depth buffer.
class RenderTarget {
 public:
  enum class Depth { kNone, k32Bit };
  /// Creates one picture of format kRgba32F.
  RenderTarget(int width, int height, Depth depth = Depth::kNone)
      : RenderTarget(width, height, {PixelFormat::kRgba32F}, depth) {}
  /// Creates pictures with undefined contents. Texture bindings remain unchanged. Throws
  /// DisplayError if the GPU has insufficient memory.
  /// @param width, height >= 1.
  /// @param formats of the outputs of the fragment stage at locations 0, 1, ...: up to eight; none
  ///     if only depth is needed.
  RenderTarget(int width, int height, const std::vector<PixelFormat>& formats, Depth depth);

  /// Makes this the target of the following draw calls, over its whole area and with all outputs.
  void Bind() const;
  void BindTexture(int unit, std::size_t output = 0) const;
  /// Binds the depth texture; the target must have been created with depth.
  void BindDepth(int unit) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }

  /// Makes the following draw calls use the depth buffer of another target of equal size.
  void UseDepthOf(const RenderTarget& other) const;

  /// Writes red, green and blue of an image into the first output; row 0 is the top. The image must
  /// have the size of the target.
  void Write(const HdrImage& image) const;

  // These functions return the drawn contents, row 0 at the top. They wait until drawing is
  // complete.
  /// Returns red, green and blue.
  [[nodiscard]] HdrImage Read() const;
  [[nodiscard]] std::vector<glm::vec4> ReadValues(std::size_t output = 0) const;
  /// Returns red, green and blue of a developed picture, one byte each.
  [[nodiscard]] DisplayImage ReadBytes() const;

 private:
  template <typename Pixel>
  void ReadInto(std::vector<Pixel>& pixels, std::size_t output, GLenum format) const;

  int width_, height_;
  std::vector<GlTexture> colours_;
  GlTexture depth_;
  GlFramebuffer framebuffer_;
};

/// Creates a target if it is missing or has a different size.
template <typename Target>
void Fit(std::optional<Target>& target, int width, int height) {
  if (target && target->width() == width && target->height() == height) return;
  target.emplace(width, height);
}

/// Creates a target with one output if it is missing or has a different size.
inline void Fit(std::optional<RenderTarget>& target, int width, int height, PixelFormat format) {
  if (target && target->width() == width && target->height() == height) return;
  target.emplace(width, height, std::vector{format}, RenderTarget::Depth::kNone);
}

/// Reads one rectangle at a time. An OpenGL context must be current in all calls.
class PixelReader {
 public:
  PixelReader() = default;
  ~PixelReader();
  PixelReader(const PixelReader&) = delete;
  PixelReader& operator=(const PixelReader&) = delete;

  /// Begins to read red, green and blue of the first output; has no effect while Busy().
  void Begin(const RenderTarget& picture, const PixelBox& part);
  /// Cancels the pending read.
  void Forget();
  /// Returns whether a read is pending.
  [[nodiscard]] bool Busy() const { return arrives_ != nullptr; }
  /// Returns the pixels of the pending read if they have arrived, which usually takes a frame or
  /// two.
  [[nodiscard]] std::optional<std::vector<std::array<float, 3>>> Poll();

 private:
  GlBuffer buffer_;
  std::size_t pixels_ = 0;
  GLsync arrives_ = nullptr;
};

/// A rectangle of a picture [pixels], row 0 at the top.
struct PictureTile {
  int left, top, width, height;
};

/// Returns tiles that cover a picture once, row by row from the upper left corner. No tile is
/// larger than largest_side x largest_side. Tiles are as equal as possible in steps of kTileStep
/// (or of largest_side, if that is less) from the lower left corner. All arguments >= 1.
inline constexpr int kTileStep = 120;
[[nodiscard]] std::vector<PictureTile> TilesOf(int width, int height, int largest_side);

/// Returns the part of the view that a tile shows: (x, y, u, v), with positions in the whole view
/// from (-1, -1), lower left, to (1, 1). A position p of the whole view is (p - (x, y)) * (u, v) in
/// the view of the tile, and in clip space p.xy is (p.xy - (x, y) * p.w) * (u, v). The view is
/// narrower by the factors u and v and shifted by (x u, y v) of itself. The whole view is (0, 0, 1,
/// 1).
[[nodiscard]] glm::dvec4 ViewOfTile(const PictureTile& tile, int width, int height);

/// A picture assembled from tiles.
///
/// A painter interpolates some quantities between every few pixels (shafts every 2 to 6, light of
/// lamps every 8) and needs pixels on both sides. Tiles are therefore painted with a rim that
/// overlaps their neighbours, and their steps coincide with those of the whole picture.
class TiledPicture {
 public:
  struct Tile {
    PictureTile kept, painted;
  };

  /// @param largest_side  largest side of a painted tile.
  /// Throws OptionError if the picture needs more memory than this machine has available.
  TiledPicture(int width, int height, int largest_side);

  [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }
  /// Returns the view that is painted for a tile.
  [[nodiscard]] glm::dvec4 ViewOf(const Tile& tile) const {
    return ViewOfTile(tile.painted, picture_.width, picture_.height);
  }
  /// Stores the painted picture of a tile without its rim.
  void Put(const Tile& tile, const HdrImage& painted);
  /// Returns the picture, once all tiles are stored.
  [[nodiscard]] HdrImage Take() { return std::move(picture_); }

 private:
  std::vector<Tile> tiles_;
  HdrImage picture_;
};

/// Returns whether the driver of the current context can draw a picture of this size, with four
/// floats per pixel, as a whole.
[[nodiscard]] bool IsDrawable(int width, int height);
/// Throws OptionError that names --size and the limits if the picture is not drawable.
void RequireDrawable(int width, int height);
/// Returns the side of the largest drawable square, to a factor of two.
[[nodiscard]] int LargestSquareOfDriver();

/// Throws OptionError that names --size if this machine does not have `bytes_per_pixel` of memory
/// available for each pixel. It has no effect on systems that do not report available memory (all
/// but Linux).
void RequireMemoryFor(int width, int height, int bytes_per_pixel);

}  // namespace alpenglow::viewer
