// SPDX-License-Identifier: MIT
// This header provides intersections of rays with the ground.
//
// Embree finds the triangle in single precision. The hit point is then recomputed from that
// triangle in double precision, so that distances do not depend on the processor's vector width.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "renderer/elevation/elevation.h"
#include "renderer/elevation/mesh.h"
#include "renderer/procedural_mountains/procedural_mountains.h"

namespace alpenglow::renderer {

struct TerrainHit {
  double distance_m;
  glm::dvec3 normal;            // unit, interpolated; on the side from which the ray came
  glm::dvec3 geometric_normal;  // unit, of the triangle; on the side from which the ray came
  /// The hit point lifted onto the smooth surface that the interpolated normals imply, if that lies
  /// outside the triangle (Hanika 2021, Ray Tracing Gems II, ch. 4). Shadow rays that start here do
  /// not show the facets at the terminator.
  glm::dvec3 smooth_point;
};

/// Triangles prepared for ray queries (Embree). Immutable; queries are safe from many threads.
class Terrain {
 public:
  explicit Terrain(TriangleMesh mesh);
  ~Terrain();
  Terrain(Terrain&&) noexcept;
  Terrain& operator=(Terrain&&) noexcept;

  /// Returns the nearest hit within length_m. Origin and direction (of any length except 0) are in
  /// the mesh's frame, at any distance from the mesh; throws InternalError unless all are finite.
  [[nodiscard]] std::optional<TerrainHit> Intersect(
      const glm::dvec3& origin, const glm::dvec3& direction,
      double length_m = std::numeric_limits<double>::infinity()) const;
  /// Returns whether the ray is blocked within (0, length_m); length_m may be infinite. The origin
  /// is moved off the surface along `normal` (the hit's geometric one) by the error bound of the
  /// hit point. Throws InternalError as Intersect does, and for a negative or NaN length.
  [[nodiscard]] bool Occluded(const glm::dvec3& origin, const glm::dvec3& normal,
                              const glm::dvec3& direction, double length_m) const;

  [[nodiscard]] const TriangleMesh& mesh() const;
  /// Returns the corners of the mesh's bounding box [m].
  [[nodiscard]] std::pair<glm::dvec3, glm::dvec3> Bounds() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace alpenglow::renderer
