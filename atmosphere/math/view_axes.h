// SPDX-License-Identifier: MIT
// The axes of a view: right and up in the picture, and forward into it.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace alpenglow::atmosphere {

struct ViewAxes {
  glm::dvec3 right{1.0, 0.0, 0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  glm::dvec3 forward{0.0, 1.0, 0.0};
};

/// Returns the unit vectors of a camera in the frame east, north, up.
/// @param heading_rad  clockwise from north. @param pitch_rad  positive is up.
/// @param roll_rad  clockwise seen from behind.
[[nodiscard]] inline ViewAxes AxesFromAngles(double heading_rad, double pitch_rad,
                                             double roll_rad) {
  const glm::dvec3 forward{std::cos(pitch_rad) * std::sin(heading_rad),
                           std::cos(pitch_rad) * std::cos(heading_rad), std::sin(pitch_rad)};
  const glm::dvec3 level_right{std::cos(heading_rad), -std::sin(heading_rad), 0.0};
  const glm::dvec3 level_up = glm::cross(level_right, forward);
  return {std::cos(roll_rad) * level_right - std::sin(roll_rad) * level_up,
          std::cos(roll_rad) * level_up + std::sin(roll_rad) * level_right, forward};
}

}  // namespace alpenglow::atmosphere
