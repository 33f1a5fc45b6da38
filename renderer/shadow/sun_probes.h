// SPDX-License-Identifier: MIT
// Where any mesh lets the sun into the air: probes along a ray, halved where light and shade meet.
//
// For meshes with overhangs, bridges, buildings, under which ShadowHeights would see only shade.
// Occlusion rays towards the middle of the sun's disk find the lit stretches; where two neighbours
// differ, halving finds the edge, and then the place where the last beam of the disk gets free,
// which says how fast the edge rises over the disk.
//
// What is thinner than the distance of two probes, and its shadow, may fall between them.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "renderer/shadow/sunlit_path.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// Immutable; safe to ask from many threads. Refers to the terrain.
class SunProbes {
 public:
  /// @param to_sun  unit vector in the frame of the terrain, z up.
  /// @param probes  along the stretch of a ray that terrain can shade, at least 2.
  SunProbes(const Terrain& terrain, const glm::dvec3& to_sun, double sun_radius_rad,
            int probes = 32);

  /// The stretches of a ray within [0, length_m] that the sun reaches; length_m is finite.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

 private:
  struct Stretch {
    double begin_m, end_m;
  };
  [[nodiscard]] Stretch WithinTheShadowOfTheBox(const glm::dvec3& origin, const glm::dvec3& unit,
                                                double length_m) const;

  const Terrain& terrain_;
  glm::dvec3 to_sun_, bottom_of_sun_;
  glm::dvec3 sunwards_, across_, upwards_;  // upwards: across sunbeams, in their vertical plane
  double highest_c_m_ = 0.0, u_high_m_ = 0.0, v_low_m_ = 0.0, v_high_m_ = 0.0;
  int probes_;
};

/// Whether vertical lines meet a mesh at most once, which ShadowHeights takes for granted: all
/// triangles face up, and nothing lies over or under any corner or middle of a triangle.
[[nodiscard]] bool IsOneSurface(const Terrain& terrain);

}  // namespace alpenglow::renderer
