// SPDX-License-Identifier: MIT
// RefractedFan tabulates rays through air that refracts them. The ray equation
//
//   dt/ds = (grad n - (t grad n) t) / n          t is the unit direction
//
// is integrated by the midpoint rule in the vertical plane of a ray. A ray that leaves the eye
// along a direction t0 is, at a distance x along t0,
//
//   p(x) = eye + x t0 - y u,     y = (x - x0)^2 g(sin(elevation), x - x0)
//
// where u is the upward direction perpendicular to t0 in that plane, and x0 the distance at which
// the ray enters the air that bends it. g varies so slowly that linear interpolation between nodes
// is enough.
//
// Between two of its points, a ray of curvature c deviates by c L^2 / 8 from its chord of length L.
// Seen from the eye, the chord stays within an angle `off` of the ray if
//
//   c L^2 / 8 = (distance + L / 2) off.
//
// Air whose density decreases with height bends rays towards the ground, so no chord lies above its
// ray. All coordinates are in the frame of SceneGround.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/refraction/refraction.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

class RefractedFan;

/// A ray of a fan. Refers to the fan.
class FanRay {
 public:
  FanRay(const RefractedFan& fan, const glm::dvec3& origin, const glm::dvec3& direction);

  /// Returns the point of the ray at a distance along its initial direction [m].
  [[nodiscard]] glm::dvec3 At(double along_m) const;
  [[nodiscard]] const RefractedFan& fan() const { return *fan_; }
  [[nodiscard]] const glm::dvec3& direction() const { return direction_; }
  /// Returns the sine of the elevation at the eye.
  [[nodiscard]] double sine() const { return sine_; }

 private:
  const RefractedFan* fan_;
  glm::dvec3 origin_, direction_, across_;
  double sine_;
  double enters_m_;
  const float* row_;  // row of g below; the next row follows
  float share_;       // weight of the next row
};

/// A table of refracted rays from one eye. Immutable, safe to share between threads.
class RefractedFan {
 public:
  /// @param eye, up  in the frame; `up` is a unit vector.
  /// @param reach_m  > 0: greatest distance at which points are evaluated.
  RefractedFan(const BendingAir& air, const glm::dvec3& eye, const glm::dvec3& up, double reach_m);

  /// Returns the length of the longest chord from a distance that stays within `off_rad` of the
  /// ray.
  [[nodiscard]] double ChordFrom(double along_m, double off_rad) const;
  /// Returns how close to the end of a chord of any length D its points stay within `off_rad` of
  /// the ray: D - d for the distance d from its start at which c d (D - d) / 2 = off d.
  [[nodiscard]] double EndOfChord(double off_rad) const;
  /// Returns a distance along a ray at which it is below a height [m above the sphere], and beyond
  /// which it does not return to this height before sinking further; infinite if there is none.
  [[nodiscard]] double SinksBelow(const FanRay& ray, double height_m) const;
  /// Returns a distance beyond which a ray stays above a height; infinite if none is known.
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
  double first_, last_;          // range of that asinh
  std::vector<float> g_per_m_;   // one row of kDistances + 1 values per elevation
};

}  // namespace alpenglow::renderer
