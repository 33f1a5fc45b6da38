// SPDX-License-Identifier: MIT
// Heights around an eye on an even grid of a local frame, from heights over latitude and longitude.
//
// How high the shade of terrain reaches into the air: what shaders need to find the dark stretches
// of a ray.
//
// As ShadowHeights (renderer/shadow/shadow_heights.h), for a card and in a hurry. Over the plane of
// u, the distance towards the sun, and v, across, the height of the shade of a beam is
//
//   Z(u, v) = max over u' >= u of z(u', v) - (u' - u) tan(E),     E the beam's elevation,
//
// found by one sweep along every line of constant v. Beams from the bottom, the middle and the top
// of the sun's disk are kept as the middle's height and half the distance of the other two: a point
// at z sees the disk's centre (z - Z) / half radii over the edge that cuts it (SunlightOverEdge,
// sunlit_path.h). Unlike there heights are read from an even grid, bilinear, so that 10^6 places
// take some 20 ms of one thread instead of a second for the triangles of a mesh.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"
#include "renderer/terrain/mesh.h"
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

/// Immutable once made. Lengths in metres, in the frame of the heights, z up.
struct ShadeMap {
  glm::dvec3 to_sun{0.0};                   // that it was made for
  glm::dvec3 sunwards{0.0}, across{0.0};    // horizontal unit vectors of u and v
  double first_u_m = 0.0, first_v_m = 0.0;  // of node (0, 0)
  double cell_m = 0.0;
  int columns = 0, lines = 0;     // along u, along v; 0 where nothing is shaded
  std::vector<glm::vec2> height;  // Z of the disk's middle and half the distance of its ends

  /// Of the beams from the disk's middle: before the first node shade goes on to fall by this.
  double tangent = 0.0;

  /// Outside this box nothing is shaded.
  double low_u_m = 0.0, high_u_m = 0.0, low_v_m = 0.0, high_v_m = 0.0;
  double floor_m = 0.0, ceiling_m = 0.0;  // the floor is the lowest ground

  [[nodiscard]] bool ShadesNothing() const { return columns == 0; }
  [[nodiscard]] const glm::vec2& at(int column, int line) const {
    return height[static_cast<std::size_t>(line) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// One thread. Nothing is shaded from a sun 3 degrees and more below the horizontal, whose beams
/// pass high over any ground that lies on this side of the planet's horizon, nor under one at 80
/// degrees and more, where only cliffs stand between the sun and the air beside them.
/// Beyond the heights ground is taken to lie as low as the lowest of them.
/// @param to_sun       unit vector in the frame of the heights.
/// @param radius_rad   angular radius of the disk, >= 0.
/// @param most_side    cells along the longer side at most; no finer than the heights are.
[[nodiscard]] ShadeMap ShadeMapOf(const HeightRaster& heights, const glm::dvec3& to_sun,
                                  double radius_rad, int most_side);

}  // namespace alpenglow::viewer
