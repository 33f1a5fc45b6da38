// SPDX-License-Identifier: MIT
// Rays of one eye in air that bends them, tabulated.
//
//   dt/ds = (grad n - (t grad n) t) / n          the ray equation, t the unit direction
//
// is followed by the midpoint rule in the vertical plane of a ray. A ray that leaves the eye along a
// direction t0 is, at a distance x along t0,
//
//   p(x) = eye + x t0 - y u,     y = (x - x0)^2 g(sin(elevation), x - x0)
//
// with u the direction across t0 in that plane, upwards, and x0 where the ray enters the air that
// bends. g changes so little that it is linear between nodes.
//
// Between two of its points a ray of the curvature c lies c L^2 / 8 from its chord. Chords are seen
// within an angle `off` of the ray where they are so short that
//
//   c L^2 / 8 = (distance + L / 2) off.
//
// Air that is thinner the higher it is bends rays towards the ground: no chord lies above its ray.
//
// Frame: that of SceneGround, the planet's centre at (0, 0, -R).
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/sun/bent_ray.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

class BentFan;

/// A ray of a fan. Refers to the fan.
class FanRay {
 public:
  FanRay(const BentFan& fan, const glm::dvec3& origin, const glm::dvec3& direction);

  /// The point of the ray at a distance along its first direction [m].
  [[nodiscard]] glm::dvec3 At(double along_m) const;
  [[nodiscard]] const BentFan& fan() const { return *fan_; }
  [[nodiscard]] const glm::dvec3& direction() const { return direction_; }
  /// Returns the sine of the elevation at the eye.
  [[nodiscard]] double sine() const { return sine_; }

 private:
  const BentFan* fan_;
  glm::dvec3 origin_, direction_, across_;
  double sine_;
  double enters_m_;
  const float* row_;  // of g, and the next one
  float share_;       // of the next one
};

/// Immutable, safe to share between threads.
class BentFan {
 public:
  /// @param eye, up  in the frame; up: unit. @param reach_m  > 0: points are asked for up to there.
  BentFan(const BendingAir& air, const glm::dvec3& eye, const glm::dvec3& up, double reach_m);

  /// Returns the length of the longest chord from a distance on that is seen so near to the ray.
  [[nodiscard]] double ChordFrom(double along_m, double off_rad) const;
  /// How near to the end of a chord, of whatever length, places on it are seen so near to the ray:
  /// c d (D - d) / 2 = off d.
  [[nodiscard]] double EndOfChord(double off_rad) const;
  /// A distance along a ray at which it is below a height [m over the sphere], and from which on the
  /// ray does not come back to it before it has been lower; infinite where there is none.
  [[nodiscard]] double SinksBelow(const FanRay& ray, double height_m) const;
  /// Returns a distance from which on a ray is above a height; infinite where none is known.
  [[nodiscard]] double RisesAbove(const FanRay& ray, double height_m) const;

  [[nodiscard]] double height_m() const { return height_m_; }
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  friend class FanRay;
  static constexpr int kElevations = 512, kDistances = 64;

  [[nodiscard]] double RowOf(double sine) const;
  [[nodiscard]] double EntersAir(double sine) const;
  void FillRow(double sine, float* row) const;

  BendingAir air_;
  glm::dvec3 up_;
  double height_m_, reach_m_;
  double most_curvature_per_m_;
  double grazing_sine_, scale_;  // rows are even in asinh((sine - grazing_sine_) / scale_)
  double first_, last_;          // of that
  std::vector<float> g_per_m_;   // a row of kDistances + 1 an elevation
};

}  // namespace alpenglow::renderer
