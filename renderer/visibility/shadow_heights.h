// SPDX-License-Identifier: MIT
// Sunlit stretches of any ray through the air over terrain, without tracing rays.
//
// Sunbeams are parallel. With u the horizontal distance towards the sun, v across and z up, all
// points of one beam have the same
//
//   c(u, z) = z cos(E) - u sin(E),      E the sun's elevation in the frame of the mesh,
//
// so that terrain q shades a point p of the same v when u_q > u_p and c_q >= c_p. The sweep finds
// the highest blocked beam on the sunward side of every place,
//
//   C(u, v) = max of c over terrain at u' >= u,
//
// on lines of constant v. The crossings of every triangle with every line are put into bins along
// u, which keeps crests exactly in place; then a running maximum is taken from the sun's side. The
// sweep is done for beams from the bottom, the middle and the top of the sun's disk. A point
// between the resulting heights sees a part of the disk. A pyramid of minima and maxima over (u, v)
// lets a ray skip air that is fully lit or fully dark. The curvature of the planet is in the mesh.
// (Shadow heights by a sweep: Timonen, Westerholm 2010, Computer Graphics Forum 29; pyramids of
// extremes for shafts: Chen, Baran, Durand, Jarosz 2011, I3D.)
//
// The ground must be a single surface over the plane. This method misses light under bridges and
// overhangs: SunProbes (sunlit_path.h) traces rays there.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "renderer/elevation/mesh.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

/// The position of the sun's disk relative to the terrain edge that cuts it, as seen from a place
/// of the ground. The ratio of both members is the height of the disk's centre over that edge in
/// radii of the disk, see SunlightOverEdge. Interpolating both members separately puts the edge of
/// a shadow at its position between places.
struct SunOverEdge {
  double clearance_m;  // clearance of the beam from the disk's centre over the edge; negative in
                       // its shade
  double radius_m;     // radius of the disk at the edge, not negative; 0 on the edge itself

  /// Returns the ratio in radii, clamped to [-limit, limit].
  [[nodiscard]] double Radii(double limit) const {
    if (std::abs(clearance_m) >= limit * radius_m) return clearance_m < 0.0 ? -limit : limit;
    return clearance_m / radius_m;
  }
};

/// Immutable; safe to use from many threads.
class ShadowHeights {
 public:
  struct Options {
    double cell_m = 0.0;  // distance of lines and bins; 0: two thirds of the mesh's spacing, at
                          // most the extent over fewest_lines
    double fewest_lines = 2048.0;                   // large triangles have sharp edges, too
    std::size_t most_cells = std::size_t{1} << 24;  // limit; the cells become coarser to respect it
    bool for_rays = true;  // enables Along(), whose pyramid takes a fifth of the memory
  };

  /// The result does not depend on the number of threads.
  /// @param to_light  unit vector in the frame of the mesh, z up.
  /// @param radius_rad  angular radius of the disk, 0 for a point.
  ShadowHeights(const TriangleMesh& mesh, const glm::dvec3& to_light, double radius_rad,
                const Options& options);
  ShadowHeights(const TriangleMesh& mesh, const glm::dvec3& to_light, double radius_rad)
      : ShadowHeights(mesh, to_light, radius_rad, Options{}) {}

  /// Returns the sunlit stretches of a ray within [0, length_m]; length_m must be finite. Throws
  /// InternalError if Options::for_rays is false.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

  /// Returns the sunlight that terrain lets through to a point in the air, in [0, 1].
  [[nodiscard]] double SunlightAt(const glm::dvec3& point) const;

  /// Returns the visibility of the sun from a place of the ground. Terrain within a cell counts as
  /// the place's own surface: the caller tests whether its normal faces the sun.
  [[nodiscard]] SunOverEdge Over(const glm::dvec3& ground) const;

  /// Returns the distance of lines and bins [m].
  [[nodiscard]] double cell_m() const { return cell_m_; }
  /// Returns the memory of the maps [bytes].
  [[nodiscard]] std::size_t bytes() const;

 private:
  // Beams from the bottom of the disk (0) to its top.
  static constexpr std::size_t kBeams = 3;
  using Beams = std::array<float, kBeams>;
  // Returns the height of the disk's centre, in radii, over an edge that cuts the disk at a beam.
  static constexpr double HeightOver(std::size_t beam) {
    return 1.0 - 2.0 * static_cast<double>(beam) / static_cast<double>(kBeams - 1);
  }
  /// Clearance of each beam over the beam that terrain blocks [m].
  using Clearances = std::array<double, kBeams>;
  /// Returns the height of the disk's centre over the edge, in radii. It is interpolated between the
  /// last beam that passes, from the top of the disk down, and the first that does not.
  [[nodiscard]] static double HeightFrom(const Clearances& clearance);
  struct Extremes {
    float highest_lower;  // C of the lowest beam: above it everything is lit
    float lowest_upper;   // C of the highest beam: below it everything is dark
  };
  struct Level {
    std::size_t columns, rows;
    std::vector<Extremes> extremes;
  };
  struct Walk;

  [[nodiscard]] Beams BeamsOf(const glm::dvec3& point) const;
  [[nodiscard]] Beams HighestAt(double column, double line) const;
  /// Returns the clearances at a point, with the terrain from a number of cells towards the sun on;
  /// nothing beside the terrain and on its sunward side.
  [[nodiscard]] std::optional<Clearances> ClearancesAt(const glm::dvec3& point, double cells) const;
  void Deposit(const TriangleMesh& mesh);
  void SweepFromTheSun();
  void BuildPyramid();

  glm::dvec3 sunwards_, across_;  // horizontal unit vectors
  std::array<double, kBeams> sine_, cosine_;
  double cell_m_ = 0.0;
  double first_u_m_ = 0.0, first_v_m_ = 0.0;
  std::size_t columns_ = 0, lines_ = 0;  // nodes along u, lines along v
  std::vector<Beams> highest_;           // C at the nodes, line by line
  std::vector<Level> levels_;            // level i has blocks of 2^(i + 1) cells a side
};

}  // namespace alpenglow::renderer
