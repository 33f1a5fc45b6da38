// SPDX-License-Identifier: MIT
// The heights that are loaded at one moment, and the pads between tiles that do not share a
// lattice.
//
// If the samples of two adjacent tiles lie off the common lattice, a lattice sample between the
// last column of one tile and the first column of the next belongs to neither tile. Such a tile is
// padded: it is extended by one of its own steps, with the heights of its neighbour there.
//
// LoadedHeights is immutable and safe to read from many threads. GroundSampler is the function by
// which the lighting and shadow code gets the heights around a place.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/layer.h"
#include "renderer/terrain/land_source.h"

namespace alpenglow::renderer {

/// Returns the heights within half_width_m of a place, with at most most_samples per side; empty if
/// there is no land. For a mesh it returns the part nearest to the place (GridOverMesh). Called on
/// other threads.
using GroundSampler = std::function<std::optional<ElevationGrid>(
    const Place& place, double half_width_m, int most_samples)>;

/// Returns the sides of tile `index` on which the lattice has samples that belong to no tile,
/// although another tile begins within one step.
/// @param extents  of all tiles, without heights.
[[nodiscard]] TilePads PadsOf(const LandLattice& lattice, const std::vector<ElevationGrid>& extents,
                              std::size_t index);

/// Returns the grid with one more row or column on each padded side, without heights.
[[nodiscard]] ElevationGrid PaddedExtent(const ElevationGrid& grid, const TilePads& pads);

/// Returns the grid of a tile with its heights and, on its pads, those of other tiles, interpolated
/// linearly. Where no other tile has heights, the rim of the tile is repeated. For the other tiles
/// only their rims are read, and only from files for which CanBeCut holds.
[[nodiscard]] ElevationGrid WithPads(const LandTiles& tiles, int tile, const ElevationGrid& grid);

/// Heights [m] of vertices of one level, rows from the north; NaN where there is none. Vertices may
/// lie beyond the lattice, whose rim they repeat.
struct HeightBlock {
  int first_i = 0, first_j = 0;
  int columns = 0, rows = 0;
  std::vector<float> height_m;

  [[nodiscard]] float at(int i, int j) const {
    return height_m[static_cast<std::size_t>((j - first_j) * columns + (i - first_i))];
  }
};

/// The tiles of a source that are in memory.
class LoadedHeights {
 public:
  /// @param heights  one per tile; null: not loaded.
  LoadedHeights(std::shared_ptr<const LandTiles> tiles,
                std::vector<std::shared_ptr<const HeightPyramid>> heights)
      : tiles_(std::move(tiles)), heights_(std::move(heights)) {}

  [[nodiscard]] const LandTiles& tiles() const { return *tiles_; }
  [[nodiscard]] const std::vector<std::shared_ptr<const HeightPyramid>>& heights() const {
    return heights_;
  }

  /// Returns vertices [first_i, first_i + columns) x [first_j, first_j + rows) of a level. Beyond
  /// the lattice its rim is repeated, except that columns go on around the earth if it closes.
  [[nodiscard]] HeightBlock Block(int level, int first_i, int first_j, int columns, int rows) const;

  /// Returns the height of the ground [m] at a place, on the two triangles of the cell around it,
  /// from the finest heights loaded there. Empty where no ground is loaded.
  [[nodiscard]] std::optional<double> HeightUnder(double latitude_rad, double longitude_rad) const;

  /// Returns the heights within `half_width_m` of a place, at most `most_samples` per side: every
  /// 2^k-th sample of the lattice, as binomial means. A lattice with no more than `most_samples` is
  /// returned whole. If the lattice closes around the earth and the heights lie around a pole or on
  /// both sides of its first column, they are interpolated: rows begin at the pole, and the columns
  /// go once around it. NaN where nothing is loaded; empty if no land is near.
  [[nodiscard]] std::optional<ElevationGrid> SampledGrid(const Place& place, double half_width_m,
                                                         int most_samples) const;

 private:
  std::shared_ptr<const LandTiles> tiles_;
  std::vector<std::shared_ptr<const HeightPyramid>> heights_;
};

/// Reads the tiles around a place and returns LoadedHeights::SampledGrid of them. Tiles are read
/// one after the other, at the level of the grid. Throws InputError as ReadLandTile does, but for
/// unreadable files in a folder, which are left out.
/// @param notes  receives the notes on the tiles and the files that were left out.
[[nodiscard]] std::optional<ElevationGrid> ReadHeightsAround(
    const std::shared_ptr<const LandTiles>& tiles, const Place& place, double half_width_m,
    int most_samples, std::vector<std::string>& notes);

/// Size [m] of one column's and one row's step of a lattice at a latitude.
struct SampleSize {
  double column_m, row_m;
};
[[nodiscard]] SampleSize SampleSizeAt(const LandLattice& lattice, double latitude_rad);

}  // namespace alpenglow::renderer
