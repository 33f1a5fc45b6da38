// SPDX-License-Identifier: MIT
// Land between tiles that do not overlap and whose samples lie off the common lattice.
//
// A sample of the lattice between the last column of one tile and the first one of the next belongs
// to no tile, unless one of them goes on: by one of its own steps, with the heights that its
// neighbour has there.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/terrain/elevation.h"
#include "viewer/land/land_lattice.h"
#include "viewer/land/land_source.h"

namespace alpenglow::viewer {

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

}  // namespace alpenglow::viewer
