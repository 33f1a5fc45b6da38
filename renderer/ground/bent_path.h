// SPDX-License-Identifier: MIT
// A ray that air bends, as straight pieces that terrain is asked about.
//
//   dt/ds = (grad n - (t grad n) t) / n          the ray equation, t the unit direction
//
// is followed by the midpoint rule: over a piece of length L the direction turns by L t'(L / 2), and
// the piece leads along t + L (t'(0) + 2 t'(L / 2)) / 6, the mean direction where t' changes evenly, so
// that the ends of pieces lie on the ray but for terms of L^3 in direction, L^4 in place. Between them a ray of
// curvature c lies c L^2 / 8 beside its chord, and pieces are as long as that may be from the eye,
//
//   c L^2 / 8 = (distance + L / 2) off,
//
// and shorter where the density changes along them.
//
// Frame: that of SceneGround, the planet's centre at (0, 0, -R).
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/sun/bent_ray.h"

namespace alpenglow {

/// A straight piece of a ray.
struct RayPiece {
  glm::dvec3 begin;
  glm::dvec3 direction;  // unit
  double length_m;
  double begin_m;  // along the ray, from the eye
};

/// A ray from the eye on, piece by piece.
class BentPath {
 public:
  /// @param direction  unit. @param off_rad  that pieces may lie beside the ray, seen from the eye.
  BentPath(const BendingAir& air, const glm::dvec3& origin, const glm::dvec3& direction,
           double off_rad);

  /// The next one, and goes on to its end.
  /// @param nothing_before_m  along the ray: pieces that end before may lie farther beside it.
  [[nodiscard]] RayPiece Next(double nothing_before_m = 0.0);

  [[nodiscard]] const glm::dvec3& here() const { return at_; }
  [[nodiscard]] double gone_m() const { return gone_m_; }
  [[nodiscard]] double HeightHere() const;
  /// Whether the ray rises where it is, and therefore from there on: air that bends gently bends
  /// less than the ground does.
  [[nodiscard]] bool Rises() const;

 private:
  [[nodiscard]] glm::dvec3 Turn(const glm::dvec3& at, const glm::dvec3& direction) const;
  [[nodiscard]] double PieceLength(double nothing_before_m) const;

  BendingAir air_;
  glm::dvec3 at_, direction_;
  double off_rad_;
  double steepest_per_m_;  // curvature at the ground
  double gone_m_ = 0.0;
};

}  // namespace alpenglow
