// SPDX-License-Identifier: MIT
#include "renderer/camera/iris.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

glm::dvec2 OnCircle(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace

Iris::Iris(int blades, double rotation_rad)
    : blades_(blades),
      rotation_rad_(rotation_rad),
      area_(blades == 0 ? kPi : 0.5 * blades * std::sin(2.0 * kPi / blades)) {}

// A disk in polar coordinates; a polygon as triangles around the middle, of which the first number
// picks one and a place along its outer side.
glm::dvec2 Iris::Point(std::array<double, 2> unit) const {
  const double r = std::sqrt(unit[1]);
  if (blades_ == 0) return r * OnCircle(2.0 * kPi * unit[0]);
  const double side = unit[0] * blades_;
  const double corner = std::min(std::floor(side), blades_ - 1.0);
  const double step = 2.0 * kPi / blades_;
  const double share = side - corner;
  return r * ((1.0 - share) * OnCircle(rotation_rad_ + corner * step) +
              share * OnCircle(rotation_rad_ + (corner + 1.0) * step));
}

double Iris::EdgeTowards(const glm::dvec2& direction) const {
  if (blades_ == 0) return 1.0;
  const double half = kPi / blades_;
  const double turn = std::atan2(direction.y, direction.x) - rotation_rad_ - half;
  return std::cos(half) / std::cos(std::remainder(turn, 2.0 * half));
}

}  // namespace alpenglow::renderer
