// SPDX-License-Identifier: MIT
// Heights around an eye on an even grid of a local frame, from heights over latitude and longitude.
#pragma once

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"
#include "renderer/terrain/height_raster.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// The ground within `half_m` east, west, north and south of the frame's origin, side x side nodes,
/// z in the frame: the curvature of the planet is in it. HeightRaster::kNothing where the grid has
/// none. Samples are joined to triangles as MeshFromElevation joins them; places of nodes are found
/// exactly every sixteenth node and linearly between, within a hundredth of a cell at 50 km below 80
/// degrees of latitude. Twice as many nodes as samples keep crests that run between nodes.
/// One thread. @param side  at least 2.
[[nodiscard]] HeightRaster HeightsAround(const ElevationGrid& grid, const LocalFrame& frame,
                                         double half_m, int side);

}  // namespace alpenglow::viewer
