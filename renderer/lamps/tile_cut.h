// SPDX-License-Identifier: MIT
// This header chooses the nodes of the lamp tree that a tile of a picture needs. The tree is cut
// where the nodes' second moments show that one lamp at the centre is accurate enough, and the
// dimmest nodes are left out.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/lamps/lamp_tree.h"

namespace alpenglow::renderer {

/// Pixels [x0, x1) by [y0, y1).
struct PixelBox {
  int x0, y0, x1, y1;
};

/// Rays of a tile's corners and its centre, with their ends; further rays sample the iris and the
/// exposure time if the camera has a lens or moves.
struct TileRays {
  std::vector<LampRayEnd> rays;
  double radius_rad = 0.0;  // of the cone around the centre that contains the tile
  /// End of a ray on a surface.
  struct End {
    glm::dvec3 point, direction;
  };
  // Ends on surfaces, at most five, in the order of the rays: the centre's end is first if it
  // exists.
  std::vector<End> ends;
  // Greatest distance of any ray's end on a surface from the first end.
  double surface_spread_m = 0.0;

  TileRays(const MovingCamera& moving, const PixelBox& box, const RayTrace& trace);

  [[nodiscard]] const glm::dvec3& middle() const { return rays[0].direction; }
  [[nodiscard]] double longest() const;
  [[nodiscard]] double shortest() const;
  /// Returns the least distance along the rays between their ends and `distance_m`.
  [[nodiscard]] double GapTo(double distance_m) const;
  /// Returns the direction of the tile's cone that is nearest to a lamp.
  [[nodiscard]] glm::dvec3 Nearest(const glm::dvec3& to_lamp) const;
  /// Returns the direction of the tile's cone that is farthest from a lamp.
  [[nodiscard]] glm::dvec3 Farthest(const glm::dvec3& to_lamp) const;

 private:
  void Add(const CameraRay& ray, const RayTrace& trace);
};

/// Returns the nodes that light the air in front of a tile. A group of lamps is one node only if
/// terrain hides it and its lamps (of large groups, eight) from the same points of the tile's rays.
[[nodiscard]] LampNodes CutInAir(const LampTree& tree, const LampStage& stage, const TileRays& tile,
                                 const glm::dvec3& eye, double pixel_angle_rad,
                                 const LampSettings& settings);
/// Returns the nodes that light surfaces in a tile; empty if it has no surfaces. Terrain may hide
/// lamps from a tile, and its surfaces may face away from them. A lamp counts if its light arrives
/// at the ends of the tile's rays; the error of omitting others is measured against the light on
/// surfaces with the orientation found there. A group of lamps is one node only if it and its lamps
/// (of large groups, eight) light all of these ends or none.
[[nodiscard]] LampNodes CutOnSurface(const LampTree& tree, const LampStage& stage,
                                     const TileRays& tile, const LampSettings& settings);

/// Returns whether a node is so far from a tile that light in the air is a parabola between lattice
/// points: over a step h, linear interpolation of 1/D has the error (h / D)^2 / 4.
[[nodiscard]] bool IsFar(const LampNode& node, const TileRays& tile, double pixel_angle_rad);

}  // namespace alpenglow::renderer
