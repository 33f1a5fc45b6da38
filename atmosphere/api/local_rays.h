// SPDX-License-Identifier: MIT
// Rays of the public headers, from points and directions in the local frame. Of a ray,
//
//   altitude = z + (x^2 + y^2) / (r + R + z),     r = distance from the centre of the planet
//
// is exact above the origin and loses no digits elsewhere.
#pragma once

#include <alpenglow/batch.h>
#include <alpenglow/geometry.h>

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string_view>

#include "atmosphere/ray/ray.h"

namespace alpenglow {

/// Returns the unit vector. Throws InputError for a direction that is not finite or has length 0.
[[nodiscard]] glm::dvec3 UnitVectorOf(const Direction& direction);

/// Altitude and zenith direction of a point.
struct AltitudeAndZenith {
  double altitude_m;
  glm::dvec3 up;  // unit vector
};
/// Throws InputError for a point that is not finite, lower than half a radius below altitude 0, or
/// higher than 1e12 m.
[[nodiscard]] AltitudeAndZenith AltitudeOf(const LocalPoint& point, double planet_radius_m);

/// Returns the cosine of the angle between two unit vectors, whose product may exceed 1 by
/// rounding.
[[nodiscard]] double CosineBetween(const glm::dvec3& a, const glm::dvec3& b);

/// @param view, to_sun  unit vectors.
[[nodiscard]] atmosphere::ViewRay RayFrom(
    const AltitudeAndZenith& eye, const glm::dvec3& view, const glm::dvec3& to_sun,
    double length_m = std::numeric_limits<double>::infinity());

/// Throws the InputError of an argument of a batch that has neither one value nor `rays` values.
[[noreturn]] void RefuseLength(std::string_view name, std::size_t length, std::size_t rays);

/// Returns the number of rays of a batch with `values` values for each ray. Throws InputError for results
/// that are no multiple of it.
[[nodiscard]] std::size_t RaysOf(std::span<const float> results, std::size_t values);

template <typename Value>
void RequireLength(std::string_view name, const OneOrMany<Value>& many, std::size_t rays) {
  if (many.size() != 1 && many.size() != rays) RefuseLength(name, many.size(), rays);
}

}  // namespace alpenglow
