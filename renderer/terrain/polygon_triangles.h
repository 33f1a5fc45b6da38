// SPDX-License-Identifier: MIT
// Polygons in space are cut into triangles that cover the same area.
//
// The polygon is seen along the axis that its normal is nearest to, which moves no coordinate, and
// triangles are cut off at its corners (Meisters 1975, "Polygons have ears"). Signs of areas are
// exact for corners in single precision.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace alpenglow::renderer {

struct PolygonTriangles {
  /// Indices of corners, wound as the polygon is. Triangles without area are left out; if all are,
  /// the polygon has no area.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Two edges cross: no triangles have the polygon's area, which itself is ambiguous. Those given
  /// share all of its corners and may overlap.
  bool crosses_itself = false;
};

/// A second of work.
inline constexpr std::size_t kMostPolygonCorners = 10000;

/// Cuts a polygon of 3 or more corners, which may be concave, may lie in any plane and nearly in
/// one, and may have collinear or repeated corners. The time grows as the square of the corners.
/// @param corners  in order [m]; their coordinates are single precision numbers.
[[nodiscard]] PolygonTriangles TrianglesOfPolygon(const std::vector<glm::dvec3>& corners);

/// A triangle has no area if it is thin for the length of its edges, whatever that length is.
[[nodiscard]] bool IsWithoutArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace alpenglow::renderer
