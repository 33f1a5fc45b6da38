// SPDX-License-Identifier: MIT
// The part of a straight way that lies inside the sphere of the planet. The planet hides what is
// behind it, unless terrain covers all of it: then only terrain hides, since a basin can lie below
// the sphere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

/// Returns whether the planet lies between two points, in a frame whose origin is on the sphere and
/// whose z axis points up there.
/// @param radius_m  of the sphere.
/// @param is_covered  whether terrain covers the planet at a point. It is asked where the way enters
///     the sphere, at its lowest point, and where it leaves the sphere or ends.
template <typename IsCovered>
[[nodiscard]] bool PlanetHides(const glm::dvec3& from, const glm::dvec3& to, double radius_m,
                               const IsCovered& is_covered) {
  constexpr double kTouches_m = 0.01;  // on the sphere except for rounding
  const glm::dvec3 way = to - from;
  const double along = -glm::dot(from + glm::dvec3(0.0, 0.0, radius_m), way) / glm::dot(way, way);
  if (!(along > 0.0 && along < 1.0)) return false;
  const double lowest_m = AltitudeOverSphere(from + along * way, radius_m);
  if (lowest_m >= -kTouches_m) return false;
  // Half of the part inside is a side of the triangle with the lowest point and the centre.
  const double half = std::sqrt(-lowest_m * (2.0 * radius_m + lowest_m)) / glm::length(way);
  const std::array<double, 3> inside{std::max(along - half, 0.0), along,
                                     std::min(along + half, 1.0)};
  return std::any_of(inside.begin(), inside.end(),
                     [&](double share) { return !is_covered(from + share * way); });
}

}  // namespace alpenglow::renderer
