// SPDX-License-Identifier: MIT
#include "renderer/terrain/smooth_normals.h"

#include <glm/geometric.hpp>

namespace alpenglow::renderer {

std::vector<std::array<float, 3>> SmoothNormals(
    const std::vector<glm::dvec3>& positions,
    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
  for (const auto& [a, b, c] : triangles) {
    const glm::dvec3 twice_area =
        glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
    sums[a] += twice_area;
    sums[b] += twice_area;
    sums[c] += twice_area;
  }
  std::vector<std::array<float, 3>> normals;
  normals.reserve(sums.size());
  for (const glm::dvec3& sum : sums) {
    const double length = glm::length(sum);
    const glm::dvec3 normal = length > 0.0 ? sum / length : glm::dvec3(0.0, 0.0, 1.0);
    normals.push_back(
        {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)});
  }
  return normals;
}

}  // namespace alpenglow::renderer
