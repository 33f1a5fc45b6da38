// SPDX-License-Identifier: MIT
// A normal for each vertex: the mean of the normals of its triangles, weighted by their areas.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace alpenglow::renderer {

/// Unit normals, one a position; (0, 0, 1) where a position belongs to no triangle.
[[nodiscard]] std::vector<std::array<float, 3>> SmoothNormals(
    const std::vector<glm::dvec3>& positions,
    const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace alpenglow::renderer
