// SPDX-License-Identifier: MIT
// Angles between directions, and of the horizon of a sphere.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace alpenglow::atmosphere {

/// Returns the angle between two directions of any length, in [0, pi]. All digits are right at all
/// angles, because the arc tangent of sine and cosine is taken: the arc cosine alone loses all
/// digits near 0 and pi.
[[nodiscard]] inline double AngleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Returns the angle [rad] from the horizontal down to the line that touches a sphere, as seen from
/// a point outside of it.
/// @param height  of the point over the sphere, >= 0.
/// @param from_centre  distance of the point from the centre of the sphere, in the same unit.
[[nodiscard]] inline double DipOfHorizon(double height, double from_centre) {
  return std::atan2(std::sqrt(height * (2.0 * from_centre - height)), from_centre - height);
}

}  // namespace alpenglow::atmosphere
