// SPDX-License-Identifier: MIT
// Two axes across a direction.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace alpenglow::atmosphere {

/// Unit vectors that are perpendicular to a direction and to each other.
struct AxesAcross {
  glm::dvec3 side, other;
};

/// Returns some axes across a unit vector: `other` is its cross product with `side`.
[[nodiscard]] inline AxesAcross AxesAcrossOf(const glm::dvec3& unit) {
  glm::dvec3 across = glm::cross(unit, glm::dvec3(0.3, -0.5, 0.8));
  if (glm::dot(across, across) < 1e-6) across = glm::cross(unit, glm::dvec3(1.0, 0.0, 0.0));
  const glm::dvec3 side = glm::normalize(across);
  return {side, glm::cross(unit, side)};
}

}  // namespace alpenglow::atmosphere
