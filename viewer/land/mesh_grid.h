// SPDX-License-Identifier: MIT
// Heights of a mesh on a grid of latitude and longitude, as light and shade of land ask for them.
#pragma once

#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"
#include "renderer/terrain/terrain.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Heights of the mesh's highest surface. The grid covers the mesh; where the mesh is wider than
/// the square around the place, the grid is as wide as the square and lies where the mesh comes
/// nearest to the place. A mesh of any size at any distance is sampled so.
/// @param frame  of the mesh's coordinates.
/// @return nothing where no two neighbouring samples could meet the mesh.
[[nodiscard]] std::optional<ElevationGrid> GridOverMesh(const Terrain& terrain,
                                                        const LocalFrame& frame,
                                                        const GeodeticPosition& place,
                                                        double half_width_m, int most_samples);

}  // namespace alpenglow::viewer
