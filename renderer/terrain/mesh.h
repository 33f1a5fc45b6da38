// SPDX-License-Identifier: MIT
// The ground as triangles in a local frame.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"
#include "renderer/terrain/elevation.h"

namespace alpenglow::renderer {

/// Triangles in the ENU frame of a LocalFrame [m], single precision: a position 100 km from the
/// origin is rounded by up to 4 mm a coordinate.
struct TriangleMesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;            // unit, one a position
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

/// A position or a normal of a mesh in double precision.
[[nodiscard]] inline glm::dvec3 ToDouble(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Every sample becomes a vertex, placed through ECEF, so curvature and
/// ellipsoid are right. Beside a void triangles are left out. A grid
/// that goes once around the earth is closed, and over a pole too.
[[nodiscard]] TriangleMesh MeshFromElevation(const ElevationGrid& grid, const LocalFrame& frame);

}  // namespace alpenglow::renderer
