// SPDX-License-Identifier: MIT
// The function by which light and shade ask for the heights of the land around a place.
//
// Land between tiles that do not overlap and whose samples lie off the common lattice.
//
// A sample of the lattice between the last column of one tile and the first one of the next belongs
// to no tile, unless one of them goes on: by one of its own steps, with the heights that its
// neighbour has there.
//
// The heights that are loaded at one moment. Immutable; safe to read from many threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"
#include "viewer/land/height_pyramid.h"
#include "viewer/land/land_source.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// The heights within half_width_m of a place, at most so many samples a side; empty where there is no
/// land. A mesh gives the part that comes nearest to the place (GridOverMesh). Other threads call it.
using GroundSampler = std::function<std::optional<ElevationGrid>(
    const GeodeticPosition& place, double half_width_m, int most_samples)>;

/// The sides of tile `index` beyond which the lattice has samples that belong to no tile, although
/// another tile begins within a step of it.
/// @param extents  of all tiles, without heights.
[[nodiscard]] TilePads PadsOf(const LandLattice& lattice, const std::vector<ElevationGrid>& extents,
                              std::size_t index);

/// A grid with one row or column more on each of these sides, without heights.
[[nodiscard]] ElevationGrid PaddedExtent(const ElevationGrid& grid, const TilePads& pads);

/// The grid of a tile with its heights and, on its pads, those of other tiles, linear between their
/// samples. Where no other tile has any, the heights of the tile's own rim go on. Of the other
/// files only rims are read, of files for which CanBeCut holds.
[[nodiscard]] ElevationGrid WithPads(const LandTiles& tiles, int tile, const ElevationGrid& grid);

/// Heights [m] of vertices of one level, rows from the north; NaN: none.
struct HeightBlock {
  int first_i = 0, first_j = 0;
  int columns = 0, rows = 0;
  std::vector<float> height_m;

  [[nodiscard]] float at(int i, int j) const {
    return height_m[static_cast<std::size_t>((j - first_j) * columns + (i - first_i))];
  }
};

class LoadedHeights {
 public:
  /// @param heights one a tile; null: not loaded.
  LoadedHeights(std::shared_ptr<const LandTiles> tiles,
                std::vector<std::shared_ptr<const HeightPyramid>> heights)
      : tiles_(std::move(tiles)), heights_(std::move(heights)) {}

  [[nodiscard]] const LandTiles& tiles() const { return *tiles_; }
  [[nodiscard]] const std::vector<std::shared_ptr<const HeightPyramid>>& heights() const {
    return heights_;
  }

  /// Vertices [first_i, first_i + columns) x [first_j, first_j + rows) of a level; beyond the
  /// lattice its rim is continued.
  [[nodiscard]] HeightBlock Block(int level, int first_i, int first_j, int columns, int rows) const;

  /// Height of the ground [m] at a place, of the two triangles that the samples around it make;
  /// nothing where no ground is loaded. As fine as what is loaded there.
  [[nodiscard]] std::optional<double> HeightUnder(double latitude_rad, double longitude_rad) const;

  /// What lies within `half_width_m` of a place, at most `most_samples` a side: every 2^k-th sample
  /// of the lattice, binomial means; all of a lattice that has no more. NaN where nothing is loaded;
  /// nothing when no land is near.
  [[nodiscard]] std::optional<ElevationGrid> SampledGrid(const GeodeticPosition& place,
                                                         double half_width_m,
                                                         int most_samples) const;

 private:
  std::shared_ptr<const LandTiles> tiles_;
  std::vector<std::shared_ptr<const HeightPyramid>> heights_;
};

/// Metres along one column's and one row's step of a lattice at a latitude.
struct SampleSize {
  double column_m, row_m;
};
[[nodiscard]] SampleSize SampleSizeAt(const LandLattice& lattice, double latitude_rad);

}  // namespace alpenglow::viewer
