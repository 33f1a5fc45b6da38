// SPDX-License-Identifier: MIT
// Rays against the ground.
//
// Embree finds the triangle in single precision; the hit point is then computed anew from that
// triangle in double, so that distances do not depend on the processor's vector width.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "renderer/terrain/built_in_range.h"
#include "renderer/terrain/elevation.h"
#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

struct TerrainHit {
  double distance_m;
  glm::dvec3 normal;            // unit, interpolated; points to the side the ray came from
  glm::dvec3 geometric_normal;  // unit, the triangle's own; points to the side the ray came from
  /// The hit point lifted onto the smooth surface that the interpolated normals imply where that
  /// lies outside the triangle (Hanika 2021, Ray Tracing Gems II, ch. 4). Shadow rays that start
  /// here do not show the facets at the terminator.
  glm::dvec3 smooth_point;
};

/// Triangles ready for rays (Embree). Immutable; safe to ask from many threads.
class Terrain {
 public:
  explicit Terrain(TriangleMesh mesh);
  ~Terrain();
  Terrain(Terrain&&) noexcept;
  Terrain& operator=(Terrain&&) noexcept;

  /// Nearest hit, not farther than a length. Origin and direction (of any length but 0) in the
  /// mesh's frame, at any distance from the mesh; throws InternalError unless all are finite.
  [[nodiscard]] std::optional<TerrainHit> Intersect(
      const glm::dvec3& origin, const glm::dvec3& direction,
      double length_m = std::numeric_limits<double>::infinity()) const;
  /// Whether anything stands within (0, length_m) of the ray; length_m may be infinite. The origin
  /// is moved off the surface along `normal` (the hit's geometric one) by the error bound of the
  /// hit point. Throws InternalError as Intersect does, and for a negative or NaN length.
  [[nodiscard]] bool Occluded(const glm::dvec3& origin, const glm::dvec3& normal,
                              const glm::dvec3& direction, double length_m) const;

  [[nodiscard]] const TriangleMesh& mesh() const;
  /// Corners of a box around it [m].
  [[nodiscard]] std::pair<glm::dvec3, glm::dvec3> Bounds() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace alpenglow::renderer
