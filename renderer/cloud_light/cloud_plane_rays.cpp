// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_plane_rays.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"

namespace alpenglow::renderer {
namespace {

/// Returns a direction by the law of cosines. @param side  1 upwards, -1 downwards.
glm::dvec3 ByCosine(int i, double side) {
  return TurnedFrom({0.0, 0.0, side}, std::sqrt(Halton(i, 5)), 2.0 * kPi * Halton(i, 7));
}

}  // namespace

glm::dvec2 CloudPlaneRays::Place(int i) const {
  return low_ + size_ * glm::dvec2(Halton(i, 2), Halton(i, 3));
}

CloudPlaneRay CloudPlaneRays::FromTop(int i) const {
  return {{{Place(i), bounds_.high.z}, ByCosine(i, -1.0)}, kPi};
}

CloudPlaneRay CloudPlaneRays::FromBase(int i) const {
  const glm::dvec3 direction =
      Halton(i, 11) < 0.5
          ? ByCosine(i, 1.0)
          : TurnedFrom(to_sun_, SampleCosine(*phase_, Halton(i, 13)), 2.0 * kPi * Halton(i, 7));
  const CloudRay ray{{Place(i), bounds_.low.z}, direction};
  if (direction.z <= 0.0) return {ray, 0.0};
  const double density =
      0.5 * direction.z / kPi + 0.5 * Phase(*phase_, glm::dot(direction, to_sun_));
  return {ray, direction.z / density};
}

}  // namespace alpenglow::renderer
