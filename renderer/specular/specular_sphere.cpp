// SPDX-License-Identifier: MIT
#include "renderer/specular/specular_sphere.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/axes_across.h"
#include "atmosphere/math/constants.h"
#include "renderer/material/reflectance.h"

namespace alpenglow::renderer {

void Validate(const SpecularSphere& sphere) {
  RequireInRange(sphere.radius_m, std::numeric_limits<double>::min(),
                 std::numeric_limits<double>::max(), "radius_m");
  RequireInRange(sphere.index, kLeastRefractiveIndex, kMostRefractiveIndex, "index");
}

std::optional<double> DistanceTo(const SpecularSphere& sphere, const glm::dvec3& origin,
                                 const glm::dvec3& direction) {
  const glm::dvec3 from_centre = origin - sphere.centre;
  const double nearest_m = -glm::dot(from_centre, direction);
  if (nearest_m <= 0.0) return std::nullopt;
  // The distance of the line from the centre is a difference of vectors, which is accurate for
  // distant origins, unlike a difference of squares.
  const glm::dvec3 across = from_centre + nearest_m * direction;
  const double half2 = sphere.radius_m * sphere.radius_m - glm::dot(across, across);
  if (half2 <= 0.0) return std::nullopt;
  const double entry_m = nearest_m - std::sqrt(half2);
  // A ray that leaves the sphere starts on it, to within rounding.
  if (entry_m <= 1e-9 * sphere.radius_m) return std::nullopt;
  return entry_m;
}

std::optional<EnteredSphere> FirstSphereOn(std::span<const SpecularSphere> spheres,
                                           const glm::dvec3& origin, const glm::dvec3& direction) {
  std::optional<EnteredSphere> first;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const std::optional<double> distance_m = DistanceTo(spheres[i], origin, direction);
    if (distance_m && (!first || *distance_m < first->distance_m)) first = {i, *distance_m};
  }
  return first;
}

DividedRay::DividedRay(const SpecularSphere& sphere, const glm::dvec3& point,
                       const glm::dvec3& direction)
    : sphere_(sphere) {
  normal_ = glm::normalize(point - sphere.centre);
  const glm::dvec3 tangent = direction - glm::dot(direction, normal_) * normal_;
  const double sine = std::min(glm::length(tangent), 1.0);
  along_ = sine > 1e-12 ? glm::normalize(tangent) : AxesAcrossOf(normal_).side;
  incident_rad_ = std::asin(sine);
  if (sphere.material == SphereMaterial::kMirror) {
    refracted_rad_ = 0.0;
    reflectance_ = 1.0;
    return;
  }
  refracted_rad_ = std::asin(sine / sphere.index);
  reflectance_ = FresnelReflectance(std::cos(incident_rad_), sphere.index);
}

double DividedRay::Share(int order) const {
  if (order == 0) return reflectance_;
  const double passed = 1.0 - reflectance_;
  return passed * passed * std::pow(reflectance_, order - 1);
}

LeavingRay DividedRay::Leaving(int order) const {
  const double angle = order * (kPi - 2.0 * refracted_rad_);
  const glm::dvec3 normal = std::cos(angle) * normal_ + std::sin(angle) * along_;
  const glm::dvec3 along = std::cos(angle) * along_ - std::sin(angle) * normal_;
  return {sphere_.centre + sphere_.radius_m * normal,
          std::cos(incident_rad_) * normal + std::sin(incident_rad_) * along};
}

double DividedRay::Deviation(int order) const {
  // Angles from the normal N towards S: pi - i before, p (pi - 2 r) + i after.
  return std::remainder(order * (kPi - 2.0 * refracted_rad_) + 2.0 * incident_rad_ - kPi,
                        2.0 * kPi);
}

std::optional<int> DividedRay::SampleOrder(double u) const {
  for (int order = 0; order <= kMostOrder; ++order) {
    const double share = Share(order);
    if (u < share) return order;
    u -= share;
  }
  return std::nullopt;
}

}  // namespace alpenglow::renderer
