// SPDX-License-Identifier: MIT
// Skyline is the elevation of the ground around an eye. If the ground is solid below its surface,
// then along each azimuth all directions below one elevation show ground and all above it show sky.
// The skyline is therefore one elevation per azimuth, which bisection finds. Azimuths are half a
// pixel apart. Between two azimuths, the ground is assumed to exceed both elevations by no more
// than the margin requested around a direction.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace alpenglow::renderer {

/// The lowest elevation of the sky by azimuth. Immutable, safe to share between threads.
class Skyline {
 public:
  /// A range of azimuths in the frame, counted from x towards y.
  struct Arc {
    double first_rad, width_rad;  // at most a full turn
  };
  using SeesSky = std::function<bool(const glm::dvec3& direction)>;

  /// @param up  at the eye, unit.
  /// @param step_rad  between azimuths, and the accuracy of elevations, > 0.
  /// @param sees_sky  safe to call from many threads.
  Skyline(const glm::dvec3& up, const Arc& arc, double step_rad, const SeesSky& sees_sky);

  /// Returns the azimuth of a direction, in the convention of Arc.
  [[nodiscard]] static double AzimuthOf(const glm::dvec3& direction, const glm::dvec3& up);
  /// Returns whether all directions within an angle of a direction are above the skyline; false if
  /// this is unknown.
  [[nodiscard]] bool IsBelow(const glm::dvec3& direction, double around_rad) const;

 private:
  [[nodiscard]] glm::dvec3 DirectionAt(double azimuth_rad, double elevation_rad) const;
  /// @param near_rad  estimated elevation.
  [[nodiscard]] double Found(double azimuth_rad, double near_rad, const SeesSky& sees_sky) const;

  glm::dvec3 up_, east_, north_;  // of the eye; unit
  double first_rad_, step_rad_;
  bool is_whole_turn_;
  std::vector<float> elevation_rad_;  // lowest elevation at which sky is visible
  double highest_rad_;
};

}  // namespace alpenglow::renderer
