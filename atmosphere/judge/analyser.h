// SPDX-License-Identifier: MIT
// What an observer's polariser sees of light that arrives somewhere along a path that is followed
// backwards: one row of weights over the light's Stokes parameters (I, Q, U, V) for each of I, Q, U
// that the observer measures (the adjoint of polarised transfer).
//
// Stokes parameters of light that is seen in direction d (it travels along -d) refer to a unit
// vector r across d: with s = d x r, Q = <E_r^2> - <E_s^2>, U = 2 <E_r E_s>.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/air/scattering_matrix.h"

namespace alpenglow::atmosphere::judge {

inline constexpr std::size_t kStokes = 3;  // that an observer measures

struct Analyser {
  std::array<std::array<double, 4>, kStokes> row{};
};

/// A turn of a path by scattering: the plane of scattering, against the reference before.
struct PlaneTurn {
  double cos_twice = 1.0, sin_twice = 0.0;  // of the angle from the reference into the plane
  glm::dvec3 reference{};                   // after: in the plane of scattering
};

/// @param reference  across `direction`, of unit length. @param next  the direction after.
[[nodiscard]] inline PlaneTurn TurnOf(const glm::dvec3& direction, const glm::dvec3& reference,
                                      const glm::dvec3& next) {
  glm::dvec3 normal = glm::cross(direction, next);
  // Straight on and straight back every plane is one of scattering.
  if (glm::dot(normal, normal) < 1e-24) normal = glm::cross(direction, reference);
  normal = glm::normalize(normal);
  const glm::dvec3 in_plane = glm::cross(normal, direction);
  const double cosine = glm::dot(reference, in_plane);
  const double sine = glm::dot(reference, normal);
  const double square = cosine * cosine + sine * sine;  // 1 but for rounding
  return {(cosine - sine) * (cosine + sine) / square, 2.0 * cosine * sine / square,
          glm::normalize(glm::cross(normal, next))};
}

/// For light before it was scattered by the turn.
[[nodiscard]] inline Analyser Scattered(const Analyser& after, const PlaneTurn& turn,
                                        const ScatteringMatrix& m) {
  Analyser before;
  for (std::size_t k = 0; k < kStokes; ++k) {
    const auto& [i, q, u, v] = after.row[k];
    const double in_q = q * turn.cos_twice - u * turn.sin_twice;
    const double in_u = q * turn.sin_twice + u * turn.cos_twice;
    before.row[k] = {i * m.a1 + in_q * m.b1, i * m.b1 + in_q * m.a2, in_u * m.a3 - v * m.b2,
                     in_u * m.b2 + v * m.a4};
  }
  return before;
}

}  // namespace alpenglow::atmosphere::judge
