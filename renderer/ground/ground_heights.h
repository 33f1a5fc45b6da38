// SPDX-License-Identifier: MIT
// The heights of the ground at a place. A mesh may have roofs, bridges and overhangs, so that the
// ground has several heights at one place: what is put on the ground stands on the highest, and
// only what is below the lowest is inside the ground.
#pragma once

#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// Heights of the lowest and of the highest surface on one vertical.
struct GroundHeights {
  double lowest_m, highest_m;
};

/// Over a point, along a vertical.
/// @param up  unit.
/// @return nothing where no surface lies within 20 km of the point.
[[nodiscard]] std::optional<GroundHeights> GroundHeightsAlong(const Terrain& terrain,
                                                              const glm::dvec3& point,
                                                              const glm::dvec3& up);
/// Over the ellipsoid, whatever the height of the place.
/// @param frame  of the terrain's coordinates.
/// @return nothing where no surface lies within 20 km of the ellipsoid.
[[nodiscard]] std::optional<GroundHeights> GroundHeightsAt(const Terrain& terrain,
                                                           const LocalFrame& frame,
                                                           const GeodeticPosition& place);

/// The surface that something at a height is over.
struct SurfaceUnder {
  TerrainHit hit;
  double height_m;
};

/// The highest surface that is not above a point; where all are above it, the highest of them.
/// @param up  unit. The height is over the point.
/// @return nothing where no surface lies below the point or within 20 km above it.
[[nodiscard]] std::optional<SurfaceUnder> SurfaceUnderPoint(const Terrain& terrain,
                                                            const glm::dvec3& point,
                                                            const glm::dvec3& up);
/// Height over the ellipsoid of the surface that an eye at a place is over.
[[nodiscard]] std::optional<double> GroundUnderEye(const Terrain& terrain, const LocalFrame& frame,
                                                   const GeodeticPosition& place);

}  // namespace alpenglow::renderer
