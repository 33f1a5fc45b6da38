// SPDX-License-Identifier: MIT
// The polarisation state of a path of the path tracer.
//
// The analyser represents the observer's polariser at a point of a path that is followed backwards:
// one row of weights over the Stokes parameters (I, Q, U, V) of the light at this point, for each
// of I, Q, U that the observer measures (the adjoint of polarised transfer).
//
// Stokes parameters of light that is seen in direction d (it propagates along -d) refer to a unit
// vector r perpendicular to d: with s = d x r, Q = <E_r^2> - <E_s^2>, U = 2 <E_r E_s>.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere::reference {

inline constexpr std::size_t kStokes = 3;  // number of parameters that an observer measures

struct Analyser {
  std::array<std::array<double, 4>, kStokes> row{};
};

/// Rotation of the reference direction at a scattering event: the scattering plane, relative to the
/// reference before it.
struct PlaneTurn {
  double cos_twice = 1.0, sin_twice = 0.0;  // of the angle from reference to scattering plane
  glm::dvec3 reference{};                   // new reference, in the scattering plane
};

/// @param reference  perpendicular to `direction`, of unit length. @param next  the direction after
/// scattering.
[[nodiscard]] inline PlaneTurn TurnOf(const glm::dvec3& direction, const glm::dvec3& reference,
                                      const glm::dvec3& next) {
  glm::dvec3 normal = glm::cross(direction, next);
  // For exact forward and backward scattering every plane is a scattering plane.
  if (glm::dot(normal, normal) < 1e-24) normal = glm::cross(direction, reference);
  normal = glm::normalize(normal);
  const glm::dvec3 in_plane = glm::cross(normal, direction);
  const double cosine = glm::dot(reference, in_plane);
  const double sine = glm::dot(reference, normal);
  const double square = cosine * cosine + sine * sine;  // 1 except for rounding
  return {(cosine - sine) * (cosine + sine) / square, 2.0 * cosine * sine / square,
          glm::normalize(glm::cross(normal, next))};
}

/// Returns the analyser for light before it was scattered by the turn.
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

}  // namespace alpenglow::atmosphere::reference
