// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_tracking.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow::renderer {

double CloudTracker::OpticalDepth(const CloudRay& ray, double farthest_m, double step_m) const {
  constexpr double kNode = 0.21132486540518712;  // (1 - 1 / sqrt 3) / 2
  double depth = 0.0;
  EachSpan(ray, farthest_m, [&](double begin_m, double end_m, double) {
    const double steps = std::ceil((end_m - begin_m) / step_m);
    const double length_m = (end_m - begin_m) / steps;
    for (double i = 0.0; i < steps; ++i) {
      depth += 0.5 * length_m *
               (Extinction_per_m(ray.At(begin_m + (i + kNode) * length_m)) +
                Extinction_per_m(ray.At(begin_m + (i + 1.0 - kNode) * length_m)));
    }
    return true;
  });
  return depth;
}

std::optional<double> CloudTracker::DistanceAt(const CloudRay& ray, double depth,
                                               double step_m) const {
  std::optional<double> found;
  EachStep(ray, kFarthestCloud_m, step_m, [&](double begin_m, double length_m, double per_m) {
    if (depth < per_m * length_m) {
      found = begin_m + depth / per_m;
      return false;
    }
    depth -= per_m * length_m;
    return true;
  });
  return found;
}

CloudDepths::CloudDepths(const CloudTracker& tracker, const CloudRay& ray, double length_m,
                         double step_m) {
  double depth = 0.0;
  tracker.EachStep(ray, length_m, step_m, [&](double begin_m, double each_m, double per_m) {
    if (per_m <= 0.0) return true;
    depth += each_m * per_m;
    nodes_.push_back({begin_m, begin_m + each_m, depth});
    return depth < kDeepest;
  });
}

double CloudDepths::Collision_m(double fraction) const {
  const double depth = -std::log1p(fraction * std::expm1(-this->depth()));
  const auto found =
      std::lower_bound(nodes_.begin(), nodes_.end() - 1, depth,
                       [](const Node& node, double value) { return node.depth < value; });
  const double before = found == nodes_.begin() ? 0.0 : std::prev(found)->depth;
  const double share = std::clamp((depth - before) / (found->depth - before), 0.0, 1.0);
  return std::lerp(found->begin_m, found->end_m, share);
}

glm::dvec3 TurnedFrom(const glm::dvec3& axis, double cosine, double azimuth_rad) {
  const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(axis, other));
  const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
  return glm::normalize(cosine * axis + sine * (std::cos(azimuth_rad) * side +
                                                std::sin(azimuth_rad) * glm::cross(axis, side)));
}

}  // namespace alpenglow::renderer
