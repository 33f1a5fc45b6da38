// SPDX-License-Identifier: MIT
// Which nodes of the tree of lamps a tile of a picture needs: the tree is cut where the nodes'
// second moments say that one lamp in the middle is as good as all, and the dimmest are left out.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/lamp/lamp_tree.h"

namespace alpenglow::renderer {

/// Pixels [x0, x1) by [y0, y1).
struct PixelBox {
  int x0, y0, x1, y1;
};

/// The rays of a tile's corners and its middle, and where they end; more by points of the iris and
/// of time where there are any.
struct TileRays {
  std::vector<LampRayEnd> rays;
  double radius_rad = 0.0;  // of the cone around the middle that holds the tile
  /// Where a ray ends on a surface.
  struct End {
    glm::dvec3 point, direction;
  };
  // On surfaces, at most those of the corners and the middle: the middle one first, or any.
  std::vector<End> ends;
  // Of the ends of all rays on surfaces: how far they lie from the first.
  double surface_spread_m = 0.0;

  TileRays(const MovingCamera& moving, const PixelBox& box, const RayTrace& trace);

  [[nodiscard]] const glm::dvec3& middle() const { return rays[0].direction; }
  [[nodiscard]] double longest() const;
  [[nodiscard]] double shortest() const;
  /// How far the ends of the rays stay from a distance.
  [[nodiscard]] double GapTo(double distance_m) const;
  /// The direction of the tile's cone that is nearest to a lamp's.
  [[nodiscard]] glm::dvec3 Nearest(const glm::dvec3& to_lamp) const;
  /// And the one that is farthest from it.
  [[nodiscard]] glm::dvec3 Farthest(const glm::dvec3& to_lamp) const;

 private:
  void Add(const CameraRay& ray, const RayTrace& trace);
};

/// Nodes that light the air before a tile: a group of lamps stands as one only where terrain hides
/// it and its lamps (of large groups, eight) from the same points of the tile's rays.
[[nodiscard]] LampNodes CutInAir(const LampTree& tree, const LampStage& stage, const TileRays& tile,
                                 const glm::dvec3& eye, double pixel_angle_rad,
                                 const LampSettings& settings);
/// Nodes that light surfaces in a tile; none without any. Terrain may hide lamps from it, and its
/// surfaces may turn from them: a lamp counts where its light arrives at the ends of the tile's
/// rays, others are left out beside it by what it brings to surfaces as they lie there, and a group
/// of lamps stands as one only where it and its lamps (of large groups, eight) light all of these
/// ends or none.
[[nodiscard]] LampNodes CutOnSurface(const LampTree& tree, const LampStage& stage,
                                     const TileRays& tile, const LampSettings& settings);

/// Far enough from a tile that light in the air is a parabola between lattice points: across h the
/// straight line misses 1/D by (h / D)^2 / 4.
[[nodiscard]] bool IsFar(const LampNode& node, const TileRays& tile, double pixel_angle_rad);

}  // namespace alpenglow::renderer
