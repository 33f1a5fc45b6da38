// SPDX-License-Identifier: MIT
#include "atmosphere/api/local_rays.h"

#include <alpenglow/errors.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow {

using atmosphere::ViewRay;

glm::dvec3 UnitVectorOf(const Direction& direction) {
  const glm::dvec3 vector{direction.east, direction.north, direction.up};
  // The squares of very long and of very short directions have no double.
  const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
  if (!(largest > 0.0 && std::isfinite(vector.x) && std::isfinite(vector.y) &&
        std::isfinite(vector.z))) {
    throw InputError(fmt::format(
        "a direction is (east {}, north {}, up {}); it must be finite and longer than 0", vector.x,
        vector.y, vector.z));
  }
  return glm::normalize(vector / largest);
}

AltitudeAndZenith AltitudeOf(const LocalPoint& point, double planet_radius_m) {
  const glm::dvec3 from_centre{point.east_m, point.north_m, planet_radius_m + point.up_m};
  const double radius_m = glm::length(from_centre);
  const double across2 = point.east_m * point.east_m + point.north_m * point.north_m;
  // A point beside or behind the planet has no digits to lose, and z is no divisor for it.
  const double altitude_m = from_centre.z > 0.0 ? point.up_m + across2 / (radius_m + from_centre.z)
                                                : radius_m - planet_radius_m;
  constexpr double kHighest_m = 1e12;
  if (!(altitude_m >= -0.5 * planet_radius_m && altitude_m <= kHighest_m)) {
    throw InputError(fmt::format(
        "a point (east_m {}, north_m {}, up_m {}) has an altitude of {} m; it must lie in [{}, {}]",
        point.east_m, point.north_m, point.up_m, altitude_m, -0.5 * planet_radius_m, kHighest_m));
  }
  return {altitude_m, from_centre / radius_m};
}

double CosineBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::clamp(glm::dot(a, b), -1.0, 1.0);
}

ViewRay RayFrom(const AltitudeAndZenith& eye, const glm::dvec3& view, const glm::dvec3& to_sun,
                double length_m) {
  return {eye.altitude_m,
          CosineBetween(view, eye.up),
          CosineBetween(to_sun, eye.up),
          CosineBetween(view, to_sun),
          length_m,
          true};
}

void RefuseLength(std::string_view name, std::size_t length, std::size_t rays) {
  throw InputError(fmt::format("{} has {} values for {} rays; it must have 1 or as many as rays",
                               name, length, rays));
}

std::size_t RaysOf(std::span<const float> results, std::size_t values) {
  if (results.size() % values != 0) {
    throw InputError(fmt::format("the result has {} values; it must have {} for each ray",
                                 results.size(), values));
  }
  return results.size() / values;
}

}  // namespace alpenglow
