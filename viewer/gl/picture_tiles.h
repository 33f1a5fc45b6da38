// SPDX-License-Identifier: MIT
// Provides tiles for pictures that are larger than the GPU can draw. Each tile is a part of the
// view.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "lut/image/image.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

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
  void Put(const Tile& tile, const Image& painted);
  /// Returns the picture, once all tiles are stored.
  [[nodiscard]] Image Take() { return std::move(picture_); }

 private:
  std::vector<Tile> tiles_;
  Image picture_;
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
