// SPDX-License-Identifier: MIT
// This header fixes the pattern of the ground, its noise and its waves, to the planet.
//
// The pattern is plane, and extruded along lines (NoiseOctave of surface.h). No plane suits the
// whole planet, so the planet has 184 of them: they touch it at parallels 15 degrees apart, and at
// each pole. Along a parallel they are as far apart as across it, and one of them touches the
// parallel at the meridian of 8 degrees, in the middle of the Alps. Pictures use the plane that is
// nearest to their eye, also along a path. All pictures of some land therefore have one pattern as
// long as their eyes have the same plane. Beyond the border between two planes the pattern is
// another one. The ground is inclined to its plane by at most 12 degrees, which stretches the
// pattern by 2 %.
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"
#include "renderer/surface/surface.h"

namespace alpenglow::renderer {

/// Returns the place where the plane nearest to another place touches the planet.
[[nodiscard]] Place PatternOrigin(const Place& place);

/// The pattern around the origin of a frame (east, north, up). Points and directions are in that
/// frame unless they are called those of the pattern. Immutable.
class GroundPattern {
 public:
  explicit GroundPattern(const LocalFrame& frame) : GroundPattern(frame, frame.origin()) {}
  /// @param eye  selects the plane.
  GroundPattern(const LocalFrame& frame, const Place& eye);

  /// Returns the coordinates of a point in the pattern [m], without altitude and width.
  [[nodiscard]] GroundPoint At(const glm::dvec3& point) const;
  /// Returns a direction in the frame of the pattern, and one of the pattern in the frame.
  [[nodiscard]] glm::dvec3 ToPattern(const glm::dvec3& direction) const {
    return pattern_from_frame_.Along(direction);
  }
  [[nodiscard]] glm::dvec3 FromPattern(const glm::dvec3& direction) const {
    return direction * pattern_from_frame_.axes();
  }

  /// Returns the direction of the planet's north pole, unit: parallel to the axis of rotation.
  [[nodiscard]] const glm::dvec3& pole() const { return pole_; }
  /// Returns the northward component of a direction at a place with a vertical; 0 at the poles.
  [[nodiscard]] double Northward(const glm::dvec3& direction, const glm::dvec3& up) const;

 private:
  FrameTransform pattern_from_frame_;
  glm::dvec3 pole_;
};

}  // namespace alpenglow::renderer
