// SPDX-License-Identifier: MIT
// Rays of a scene in the flat frame of cloud fields.
//
// A field of clouds lies in a flat frame, a scene on a sphere of radius R. A point at the angle theta
// from the vertical of the scene's origin, in the direction e and at the altitude z, is in the flat
// frame at
//
//   (R theta e, z)        azimuthal equidistant projection
//
// so that altitudes and distances from the origin are true. A straight ray is a curve in the flat
// frame; chords of at most kLongestChord_m leave it by 5 m at most. Distances across the direction to
// the origin are stretched by theta / sin(theta), which is 1.0004 at 300 km.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr double kLongestChord_m = 16000.0;

/// Returns the place of a point of a scene in the flat frame.
[[nodiscard]] glm::dvec3 InFlatFrame(const glm::dvec3& point, double planet_radius_m);

/// A part of a ray, straight in the flat frame.
struct CloudChord {
  double begin_m, end_m;  // on the ray
  glm::dvec3 origin;      // in the flat frame
  glm::dvec3 direction;   // unit, in the flat frame
  double length_m;        // in the flat frame

  /// Returns the distance on the ray of a distance on the chord.
  [[nodiscard]] double OnRay(double along_m) const {
    return begin_m + along_m / length_m * (end_m - begin_m);
  }
};

/// A range of altitudes over the sphere.
struct AltitudeRange {
  double low_m, high_m;
};

/// Returns the distances in (0, length_m) at which a ray crosses an altitude, in order: none to two.
[[nodiscard]] std::vector<double> CrossingsOf(double altitude_m, const glm::dvec3& origin,
                                              const glm::dvec3& direction, double length_m,
                                              double planet_radius_m);

/// Returns the parts of a ray within a range of altitudes, in order, cut to chords. The planet does
/// not end the ray.
/// @param length_m  of the ray; may be infinite. @param longest_m  chord, at most kLongestChord_m.
[[nodiscard]] std::vector<CloudChord> ChordsWithin(const AltitudeRange& range,
                                                   const glm::dvec3& origin,
                                                   const glm::dvec3& direction, double length_m,
                                                   double planet_radius_m,
                                                   double longest_m = kLongestChord_m);

}  // namespace alpenglow::renderer
