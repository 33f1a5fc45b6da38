// SPDX-License-Identifier: MIT
// Visibility of chunks: view-frustum culling and occlusion by nearer land.
//
// If a surface has no overhangs and is seen from above, a line of sight that passes below a point
// of the surface has entered the ground before. All land behind a crest that appears lower than the
// crest is therefore hidden. The skyline of the chunks visited so far is kept by azimuth. (An
// occlusion horizon, after Downs, L. et al. (2001), Occlusion horizons for driving through urban
// scenery, I3D 2001.)
//
// Both tests are conservative: no visible chunk is culled. They keep the order of the chunks. The
// eye is given by the transform from its frame to that of the anchor.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <queue>
#include <span>
#include <vector>

#include "atmosphere/math/view_axes.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/terrain/land_chunk.h"

namespace alpenglow::renderer {

/// The part of a view that the choice of land depends on.
struct LandView {
  /// In the frame east, north, up of the eye. The axes right and up reach from the middle of the
  /// picture to its sides, where forward is 1.
  ViewAxes axes;
  int rays = 1;              // rays per pixel; terrain is finer for more
  double bends_per_m = 0.0;  // largest curvature of light rays, which raises land
};

/// A chunk to draw from a slot of the caller's buffers. Along `coarse_sides` the odd vertices are
/// left out.
struct SeenChunk {
  int slot;
  const LandChunk* chunk;
  unsigned coarse_sides;
};

class LandSkyline {
 public:
  LandSkyline() { tangent_.fill(-1e30); }

  /// A vertex that morphs between levels of detail lies on the segment between two points. East,
  /// north, up of the eye [m].
  struct Between {
    glm::dvec3 one, other;
  };
  /// Adds a line of the surface. It may hide points that are farther than all of the line.
  void Add(std::span<const Between> line);

  /// Returns whether everything within `radius_m` of a point and no higher than `highest_m` above
  /// the eye is hidden by nearer lines. Conservative: never true for a visible point. Calls must be
  /// in the order of nearest distances (NearestOf), since lines nearer than one point are applied
  /// for all later points.
  [[nodiscard]] bool Hides(const glm::dvec3& point, double radius_m, double highest_m);
  [[nodiscard]] static double NearestOf(const glm::dvec3& point, double radius_m);

 private:
  static constexpr int kBins = 1024;  // bins of azimuth for the full circle
  struct Step {
    int bin;
    double tangent;
  };
  // A part of one line over which the azimuth is monotonic.
  struct Crest {
    double farthest_m;
    std::vector<Step> steps;
    [[nodiscard]] bool operator<(const Crest& other) const {
      return farthest_m > other.farthest_m;  // nearest first
    }
  };
  class CrestMaker;
  void Raise(double up_to_m);

  std::array<double, kBins> tangent_;  // tangent of the skyline's elevation
  std::priority_queue<Crest> waiting_;
};

/// Returns the chunks that may be in the view frustum, at their true position or raised by
/// refraction.
[[nodiscard]] std::vector<SeenChunk> InView(std::vector<SeenChunk> chunks,
                                            const FrameTransform& eye, const LandView& view);

/// Returns the chunks with a part that nearer land does not hide (LandSkyline), for an eye above
/// the ground.
/// @param bends_per_m  largest curvature of light rays.
[[nodiscard]] std::vector<SeenChunk> WithoutHidden(const std::vector<SeenChunk>& chunks,
                                                   const FrameTransform& eye, double bends_per_m);

/// Returns an upper bound for the distance of any part of the chunks from the eye [m].
[[nodiscard]] double FarthestOf(const std::vector<SeenChunk>& chunks, const FrameTransform& eye);

}  // namespace alpenglow::renderer
