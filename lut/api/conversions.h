// SPDX-License-Identifier: MIT
// Conversions between values of the public headers and those of this layer. Of a ray,
//
//   altitude = z + (x^2 + y^2) / (r + R + z),     r = distance from the centre of the planet
//
// is exact above the origin and loses no digits elsewhere.
#pragma once

#include <alpenglow/geometry.h>
#include <alpenglow/progress.h>

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>

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

/// Returns a function that may be called from any thread after each part of a task, and passes the
/// fraction of the parts that are done to `progress`. It throws Cancelled if that returns false. The
/// function holds a copy of `progress`, which may be empty.
[[nodiscard]] std::function<void()> PartDone(ProgressFunction progress, std::size_t parts);
/// Returns such a function for another fraction of the number of parts that are done.
[[nodiscard]] std::function<void()> PartDone(ProgressFunction progress,
                                             std::function<double(std::size_t done)> fraction_of);

}  // namespace alpenglow
