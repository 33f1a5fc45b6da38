// SPDX-License-Identifier: MIT
// What near land hides of far land.
//
// Over a surface without overhangs, seen from above it, a line of sight that passes below a point
// of the surface has gone into the ground before: all land behind a crest and lower than it, as
// the eye sees both, is hidden. The skyline of what has been drawn so far is kept by azimuth.
// (An occlusion horizon, after Downs, L. et al. (2001), Occlusion horizons for driving through
// urban scenery, I3D 2001.)
//
// Which chunks the eye may see. Never leaves one out by mistake; keeps their order.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <queue>
#include <span>
#include <vector>

#include "viewer/land/chunk_set.h"
#include "viewer/land/land_pass.h"

namespace alpenglow::viewer {

class Skyline {
 public:
  Skyline() { tangent_.fill(-1e30); }

  /// A vertex of the surface lies between two points: on its way between levels of detail. East,
  /// north, up of the eye [m].
  struct Between {
    glm::dvec3 one, other;
  };
  /// Adds a line of the surface: what is farther than all of it may be hidden by it.
  void Add(std::span<const Between> line);

  /// Whether all that lies within `radius_m` of a point and is no higher than `highest_m` over the
  /// eye is hidden by lines that are nearer; never so by mistake. Ask in the order of the nearest
  /// distances (NearestOf): lines that are nearer than one count for all that follow.
  [[nodiscard]] bool Hides(const glm::dvec3& point, double radius_m, double highest_m);
  [[nodiscard]] static double NearestOf(const glm::dvec3& point, double radius_m);

 private:
  static constexpr int kBins = 1024;  // of azimuth, once around
  struct Step {
    int bin;
    double tangent;
  };
  // Of one line, as far as its azimuth runs one way.
  struct Crest {
    double farthest_m;
    std::vector<Step> steps;
    [[nodiscard]] bool operator<(const Crest& other) const {
      return farthest_m > other.farthest_m;  // nearest first
    }
  };
  class CrestMaker;
  void Raise(double up_to_m);

  std::array<double, kBins> tangent_;  // of the skyline's elevation
  std::priority_queue<Crest> waiting_;
};

/// Those that may reach into the view, where they are or lifted by bent rays.
[[nodiscard]] std::vector<ChunkBuffers::Drawn> InView(std::vector<ChunkBuffers::Drawn> chunks,
                                                      const EyeInAnchor& eye, const LandView& view);

/// Those that have a part which no nearer land hides (skyline.h), for an eye over the ground.
/// @param bends_per_m  most curvature of rays.
[[nodiscard]] std::vector<ChunkBuffers::Drawn> WithoutHidden(
    const std::vector<ChunkBuffers::Drawn>& chunks, const EyeInAnchor& eye, double bends_per_m);

/// No part of them is farther from the eye [m].
[[nodiscard]] double FarthestOf(const std::vector<ChunkBuffers::Drawn>& chunks,
                                const EyeInAnchor& eye);

}  // namespace alpenglow::viewer
