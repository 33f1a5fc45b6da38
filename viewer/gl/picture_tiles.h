// SPDX-License-Identifier: MIT
// Pictures larger than a graphics card draws: painted tile by tile, each a part of the view.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "lut/picture/image.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// A rectangle of a picture [pixels], row 0 at the top.
struct PictureTile {
  int left, top, width, height;
};

/// Row by row from the upper left corner: tiles that cover a picture once, none larger than
/// largest_side x largest_side, as equal as they can be in steps of kTileStep from the lower left
/// corner (of largest_side, where that is less). All arguments >= 1.
inline constexpr int kTileStep = 120;
[[nodiscard]] std::vector<PictureTile> TilesOf(int width, int height, int largest_side);

/// Which part of the view a tile sees: (x, y, u, v), with positions in the whole view from (-1, -1),
/// lower left, to (1, 1). A position p of the whole view is (p - (x, y)) * (u, v) in the tile's, and
/// in clip space p.xy is (p.xy - (x, y) * p.w) * (u, v): a view u and v times as narrow, shifted by
/// (x u, y v) of itself. The whole view is (0, 0, 1, 1).
[[nodiscard]] glm::dvec4 ViewOfTile(const PictureTile& tile, int width, int height);

/// A picture put together.
///
/// What a painter interpolates between every few pixels (shafts, lamps' light: 2 to 6, 8) needs pixels
/// on both sides: tiles are painted with a rim of their neighbours, and begin where such steps do in
/// the whole picture.
class TiledPicture {
 public:
  struct Tile {
    PictureTile kept, painted;
  };

  /// @param largest_side  of what is painted. Throws OptionError when the picture would take more
  /// memory than this machine has to spare.
  TiledPicture(int width, int height, int largest_side);

  [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }
  /// Of what is painted for a tile.
  [[nodiscard]] glm::dvec4 ViewOf(const Tile& tile) const {
    return ViewOfTile(tile.painted, picture_.width, picture_.height);
  }
  /// What was painted for the tile, with its rim.
  void Put(const Tile& tile, const Image& painted);
  /// The picture, once all tiles are put.
  [[nodiscard]] Image Take() { return std::move(picture_); }

 private:
  std::vector<Tile> tiles_;
  Image picture_;
};

/// Whether the driver of the current context draws a picture of this size, four floats a pixel, in
/// one piece.
[[nodiscard]] bool IsDrawable(int width, int height);
/// Throws OptionError naming --size and the limits when it does not.
void RequireDrawable(int width, int height);
/// The side of the largest square that is drawable, to a factor of two.
[[nodiscard]] int LargestSquareOfDriver();

/// Throws OptionError naming --size when this machine has not `bytes_per_pixel` of memory to spare
/// for each pixel. Only where the system tells (Linux).
void RequireMemoryFor(int width, int height, int bytes_per_pixel);

}  // namespace alpenglow::viewer
