// SPDX-License-Identifier: MIT
// HeightsAround resamples heights from latitude and longitude to an even grid of a local frame.
#pragma once

#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/elevation/mesh.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns the ground within `half_m` east, west, north and south of the frame's origin, as side x
/// side nodes with z in the frame, which includes the curvature of the planet.
/// HeightRaster::kNothing where the grid has no height. Samples are joined to triangles as in
/// MeshFromElevation. The positions of nodes are computed exactly for every sixteenth node and
/// linearly in between, accurate to a hundredth of a cell at 50 km below 80 degrees of latitude.
/// Twice as many nodes as samples preserve crests that run between nodes. Uses one thread.
/// @param side  at least 2.
[[nodiscard]] HeightRaster HeightsAround(const ElevationGrid& grid, const LocalFrame& frame,
                                         double half_m, int side);

}  // namespace alpenglow::renderer
