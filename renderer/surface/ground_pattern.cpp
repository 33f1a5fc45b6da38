// SPDX-License-Identifier: MIT
#include "renderer/surface/ground_pattern.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

Place PatternOrigin(const Place& place) {
  constexpr double kStep_rad = 15.0 * kRadiansPerDegree, kAlps_rad = 8.0 * kRadiansPerDegree;
  const double latitude_rad = kStep_rad * std::round(place.latitude_rad() / kStep_rad);
  const double around = std::round(2.0 * kPi * std::cos(latitude_rad) / kStep_rad);
  if (around < 1.0) return PlaceFromRadians(latitude_rad, 0.0, 0.0);
  const double step_rad = 2.0 * kPi / around;
  const double steps = std::round((place.longitude_rad() - kAlps_rad) / step_rad);
  return WithWrappedLongitude(PlaceFromRadians(latitude_rad, kAlps_rad + steps * step_rad, 0.0));
}

GroundPattern::GroundPattern(const LocalFrame& frame, const Place& eye)
    : pattern_from_frame_(LocalFrame(frame.ellipsoid(), PatternOrigin(eye)), frame),
      pole_(0.0, std::cos(frame.origin().latitude_rad()), std::sin(frame.origin().latitude_rad())) {
}

GroundPoint GroundPattern::At(const glm::dvec3& point) const {
  const glm::dvec3 at = pattern_from_frame_.Point(point);
  GroundPoint ground{at.x, at.y, 0.0, 0.0};
  ground.up_m = at.z;
  return ground;
}

double GroundPattern::Northward(const glm::dvec3& direction, const glm::dvec3& up) const {
  constexpr double kAtThePole = 1e-9;
  const glm::dvec3 north = pole_ - glm::dot(pole_, up) * up;
  return glm::dot(direction, north) / std::max(glm::length(north), kAtThePole);
}

}  // namespace alpenglow::renderer
