// SPDX-License-Identifier: MIT
// This header cuts polygons in space into triangles.
//
// TrianglesOfPolygon keeps the total area of a polygon in space. The polygon is projected along the
// axis nearest to its normal, which changes no coordinate, and triangles are cut off at its corners
// (Meisters 1975, "Polygons have ears"). Signs of areas are exact for corners in single precision.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

struct PolygonTriangles {
  /// Indices of corners, wound like the polygon. Triangles without area are omitted; if all are,
  /// the polygon has no area.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Two edges cross. The area of the polygon is then ambiguous and no triangulation reproduces it.
  /// The returned triangles use all of its corners and may overlap.
  bool crosses_itself = false;
};

/// Largest number of corners: a second of work.
inline constexpr std::size_t kMostPolygonCorners = 10000;

/// Cuts a polygon of 3 or more corners, which may be concave, may lie in any plane and only
/// approximately in one, and may have collinear or repeated corners. The time is quadratic in the
/// number of corners.
/// @param corners  in order [m]; their coordinates are single precision numbers.
[[nodiscard]] PolygonTriangles TrianglesOfPolygon(const std::vector<glm::dvec3>& corners);

/// Returns whether a triangle has no area: it is thin relative to the length of its edges,
/// independent of scale.
[[nodiscard]] bool IsWithoutArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace alpenglow::renderer
