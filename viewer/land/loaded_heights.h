// SPDX-License-Identifier: MIT
// The heights that are loaded at one moment. Immutable; safe to read from many threads.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/land/height_pyramid.h"
#include "viewer/land/land_source.h"

namespace alpenglow::viewer {

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
