// SPDX-License-Identifier: MIT
// How high the ground stands around an eye.
//
// Over ground that is solid below its surface, as far as one looks up from where the ground is seen,
// no more of it comes after the first sky: below that all is ground, above it all is sky. So the
// skyline is one elevation an azimuth, which halving finds. Azimuths are half a pixel apart, and what
// stands between two of them is taken to be no higher than both by more than what is asked for
// around a direction.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace alpenglow::renderer {

/// Immutable, safe to share between threads.
class Skyline {
 public:
  /// The arc is of azimuths in the frame, from x over y.
  struct Arc {
    double first_rad, width_rad;  // a whole turn at most
  };
  using SeesSky = std::function<bool(const glm::dvec3& direction)>;

  /// @param up  at the eye, unit. @param step_rad  between azimuths, and how exactly elevations are
  ///     found, > 0. @param sees_sky  safe to ask from many threads.
  Skyline(const glm::dvec3& up, const Arc& arc, double step_rad, const SeesSky& sees_sky);

  /// Returns the azimuth of a direction as an Arc has it.
  [[nodiscard]] static double AzimuthOf(const glm::dvec3& direction, const glm::dvec3& up);
  /// Returns whether all directions within an angle of one are over the skyline; false where that is not known.
  [[nodiscard]] bool IsBelow(const glm::dvec3& direction, double around_rad) const;

 private:
  [[nodiscard]] glm::dvec3 DirectionAt(double azimuth_rad, double elevation_rad) const;
  /// @param near_rad  where it may be.
  [[nodiscard]] double Found(double azimuth_rad, double near_rad, const SeesSky& sees_sky) const;

  glm::dvec3 up_, east_, north_;  // of the eye; unit
  double first_rad_, step_rad_;
  bool is_whole_turn_;
  std::vector<float> elevation_rad_;  // the lowest at which sky is seen
  double highest_rad_;
};

}  // namespace alpenglow::renderer
