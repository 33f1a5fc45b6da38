// SPDX-License-Identifier: MIT
// Where terrain lets the sun into the air: the lit stretches of any ray, without tracing rays.
//
// Sunbeams are parallel. With u the horizontal distance towards the sun, v across and z up, all
// points of one beam have the same
//
//   c(u, z) = z cos(E) - u sin(E),      E the sun's elevation in the frame of the mesh,
//
// so that terrain q shades a point p of the same v when u_q > u_p and c_q >= c_p. The sweep finds
// the highest beam that is cut off sunwards of every place,
//
//   C(u, v) = max of c over terrain at u' >= u,
//
// on lines of constant v: the crossings of every triangle with every line are put into bins along
// u, which keeps crests exactly where they are, and a running maximum from the sun's side does the
// rest. It is done for beams from the bottom, the middle and the top of the sun's disk, and between
// the heights that they reach a point sees a part of the disk. A pyramid of extremes over (u, v)
// then lets a ray skip air that is wholly lit or wholly dark. The curvature of the planet is in the
// mesh. (Shadow heights by a sweep: Timonen, Westerholm 2010, Computer Graphics Forum 29; pyramids
// of extremes for shafts: Chen, Baran, Durand, Jarosz 2011, I3D.)
//
// For ground that is one surface over the plane. Under bridges and overhangs light passes where
// this sees none: SunProbes (sunlit_path.h) follows rays there.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "renderer/shadow/sunlit_path.h"
#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

/// The sun's disk over the edge of terrain that cuts it, as a place of the ground sees it. Their
/// ratio is the height of the disk's centre over that edge in radii of the disk, see
/// SunlightOverEdge; interpolated apart they put the edge of a shadow where it lies between places.
struct SunOverEdge {
  double clearance_m;  // by how much the beam from the disk's centre passes over the edge; less
                       // than 0 in its shade
  double radius_m;     // what the disk's radius is there, not negative; 0 on the edge itself

  /// In radii, between -limit and limit.
  [[nodiscard]] double Radii(double limit) const {
    if (std::abs(clearance_m) >= limit * radius_m) return clearance_m < 0.0 ? -limit : limit;
    return clearance_m / radius_m;
  }
};

/// Immutable; safe to ask from many threads.
class ShadowHeights {
 public:
  struct Options {
    double cell_m = 0.0;  // distance of lines and bins; 0: two thirds of the mesh's spacing,
                          // at most the extent over fewest_lines
    double fewest_lines = 2048.0;                   // for large triangles have sharp edges, too
    std::size_t most_cells = std::size_t{1} << 24;  // coarser cells rather than more than these
    bool for_rays = true;  // whether Along() is asked, whose pyramid is a fifth of the memory
  };

  /// The same for any number of threads.
  /// @param to_sun  unit vector in the frame of the mesh, z up.
  /// @param sun_radius_rad  angular radius of the disk, 0 for a point.
  ShadowHeights(const TriangleMesh& mesh, const glm::dvec3& to_sun, double sun_radius_rad,
                const Options& options);
  ShadowHeights(const TriangleMesh& mesh, const glm::dvec3& to_sun, double sun_radius_rad)
      : ShadowHeights(mesh, to_sun, sun_radius_rad, Options{}) {}

  /// The stretches of a ray within [0, length_m] that the sun reaches; length_m may be infinite.
  /// Throws InternalError where Options::for_rays said otherwise.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

  /// What the ground there sees of the sun. Terrain within a cell counts as the place's own
  /// surface: whether that faces the sun is its normal's to say.
  [[nodiscard]] SunOverEdge Over(const glm::dvec3& ground) const;

  /// Distance of lines and bins [m].
  [[nodiscard]] double cell_m() const { return cell_m_; }
  /// Memory of the maps [bytes].
  [[nodiscard]] std::size_t bytes() const;

 private:
  // Beams from the bottom of the disk (0) to its top.
  static constexpr std::size_t kBeams = 3;
  using Beams = std::array<float, kBeams>;
  // How far the disk's centre stands over an edge that cuts it at a beam, in radii.
  static constexpr double HeightOver(std::size_t beam) {
    return 1.0 - 2.0 * static_cast<double>(beam) / static_cast<double>(kBeams - 1);
  }
  struct Extremes {
    float highest_lower;  // C of the lowest beam: over it all is lit
    float lowest_upper;   // C of the highest: under it all is dark
  };
  struct Level {
    std::size_t columns, rows;
    std::vector<Extremes> extremes;
  };
  struct Walk;

  [[nodiscard]] Beams BeamsOf(const glm::dvec3& point) const;
  [[nodiscard]] Beams HighestAt(double column, double line) const;
  void Deposit(const TriangleMesh& mesh);
  void SweepFromTheSun();
  void BuildPyramid();

  glm::dvec3 sunwards_, across_;  // horizontal unit vectors
  std::array<double, kBeams> sine_, cosine_;
  double cell_m_ = 0.0;
  double first_u_m_ = 0.0, first_v_m_ = 0.0;
  std::size_t columns_ = 0, lines_ = 0;  // nodes along u, lines along v
  std::vector<Beams> highest_;           // C at the nodes, line by line
  std::vector<Level> levels_;            // of 2^(level + 1) cells a side
};

}  // namespace alpenglow::renderer
