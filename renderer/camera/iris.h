// SPDX-License-Identifier: MIT
// The opening that lets light into a lens: round, or with straight blades.
#pragma once

#include <array>
#include <glm/vec2.hpp>

namespace alpenglow::renderer {

/// A disk of radius 1, or a regular polygon inscribed in it.
class Iris {
 public:
  /// @param blades  0: round; else at least 3. @param rotation_rad  of the first corner from the
  ///     right, counterclockwise as seen from behind the camera.
  explicit Iris(int blades = 0, double rotation_rad = 0.0);

  /// A point of the opening, uniform in area when `unit` is uniform in the unit square.
  [[nodiscard]] glm::dvec2 Point(std::array<double, 2> unit) const;

  /// Distance of the edge from the middle, in the direction of a vector that is not 0.
  [[nodiscard]] double EdgeTowards(const glm::dvec2& direction) const;

  [[nodiscard]] double area() const { return area_; }

 private:
  int blades_;
  double rotation_rad_;
  double area_;
};

}  // namespace alpenglow::renderer
