// SPDX-License-Identifier: MIT
// Height of terrain shadows in the air, which shaders need to find the shadowed stretches of a ray.
//
// SunShadowMap is a faster version of ShadowHeights (renderer/visibility/shadow_heights.h) for the
// GPU. Over the plane of u, the distance towards the sun, and v, across it, the height of the
// shadow for a beam is
//
//   Z(u, v) = max over u' >= u of z(u', v) - (u' - u) tan(E),     E the beam's elevation,
//
// found by one sweep along every line of constant v. The map holds the height for the beam from the
// middle of the sun's disk, and half the height difference of the beams from its bottom and top: a
// point at z sees the disk's centre (z - Z) / half radii above the edge that cuts it
// (SunlightOverEdge, sunlit_path.h). ShadowHeights uses the triangles of a mesh and takes a second
// for 10^6 places. Here the heights come from an even grid with bilinear interpolation, and 10^6
// places take some 20 ms on one thread.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/elevation/mesh.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Heights of the shadow of terrain for one direction of the sun. Immutable once made. Lengths in
/// metres, in the frame of the heights, z up.
struct SunShadowMap {
  glm::dvec3 to_light{0.0};                 // direction of the sun
  glm::dvec3 sunwards{0.0}, across{0.0};    // horizontal unit vectors of u and v
  double first_u_m = 0.0, first_v_m = 0.0;  // of node (0, 0)
  double cell_m = 0.0;
  int columns = 0, lines = 0;     // along u, along v; 0: nothing is shadowed
  std::vector<glm::vec2> height;  // Z of the disk's middle, half of bottom minus top

  /// Tangent of the elevation of the beam from the disk's middle. Before the first node the shadow
  /// continues to descend with it.
  double tangent = 0.0;

  /// Outside this box nothing is shadowed.
  double low_u_m = 0.0, high_u_m = 0.0, low_v_m = 0.0, high_v_m = 0.0;
  double floor_m = 0.0, ceiling_m = 0.0;  // the floor is the lowest ground

  [[nodiscard]] bool ShadesNothing() const { return columns == 0; }
  [[nodiscard]] const glm::vec2& at(int column, int line) const {
    return height[static_cast<std::size_t>(line) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// Computes the map on one thread. The map is empty for a sun at 3 degrees or more below the
/// horizontal, whose beams pass high above any ground on this side of the planet's horizon, and for
/// a sun at 80 degrees or more, where only cliffs shadow the air next to them. Beyond the heights,
/// the ground is assumed to be as low as the lowest of them.
/// @param to_light      unit vector in the frame of the heights.
/// @param radius_rad  angular radius of the disk, >= 0.
/// @param most_side   largest number of cells along the longer side. Cells are no smaller than
///   those of the heights.
[[nodiscard]] SunShadowMap SunShadowMapOf(const HeightRaster& heights, const glm::dvec3& to_light,
                                          double radius_rad, int most_side);

}  // namespace alpenglow::renderer
