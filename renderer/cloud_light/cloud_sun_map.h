// SPDX-License-Identifier: MIT
// Optical depth from any point to the sun, from a map sheared along the sun's direction s.
//
//   tau(u, v, k),   (u, v) = (x, y) - (z - z_0) (s_x, s_y) / s_z
//
// All points of a sunbeam have one foot (u, v) on the plane z_0 of the lowest cloud, and the optical
// depth towards the sun falls along the beam from level to level k. A shear keeps a periodic field
// periodic, and the beam through a node is integrated without interpolation. Only levels between
// which a beam meets cloud are stored: one bit says so for each, and 16 bits hold the optical depth
// below it as (q / 65535)^2 64. The error of rounding is below 2.5e-4 up to an optical depth of 4;
// depths above 64 are stored as 64, and beams end where they reach it: under a low sun few pass the
// whole layer.
//
// Between beams the transmittance is linear, so that the mean of a shadow is that of the beams, but
// clouds are blurred over cells of 20 m. OpticalDepthToSun() therefore takes steps of 5 m times 1.2^n
// through the field first, and the map 120 m ahead, or where the optical depth is 8. Steps that grow
// faster make the mean transmittance too large, because their optical depth has more noise, and with
// the map 60 m ahead it is 4 to 5 % too small under a sun at 12 degrees.
//
// TransmittanceAround() is for shafts far from the eye: a mean over blocks of about 80 m in all
// directions, of 16 bits each. It costs a tenth, and has no noise where samples are further apart
// than the cells of the map.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// The lowest sun of a map: the shear is 19, and beams cross 20 km of a layer 1 km deep.
inline constexpr double kLowestCloudSun_deg = 3.0;

struct CloudSunMapOptions {
  /// Distance between neighbouring beams, in [1, 1000]. On the ground they are further apart along x
  /// by 1 / sqrt(1 - s_x^2), at most 4, and likewise along y; a period is a multiple of the cells.
  double cell_m = 20.0;
  /// Largest step along a beam.
  double step_m = 20.0;  // in [1, 100]
};

/// Immutable; safe to use from many threads. It does not refer to the field.
class CloudSunMap {
 public:
  /// Integrates the beams of all nodes, with as many threads as are free; the result does not
  /// depend on their number. Throws InputError for a sun below kLowestCloudSun_deg or options out
  /// of range.
  /// @param to_sun  unit vector.
  CloudSunMap(const CloudField& field, const glm::dvec3& to_sun,
              const CloudSunMapOptions& options = {});

  [[nodiscard]] const glm::dvec3& to_sun() const { return to_sun_; }

  /// Returns the transmittance from a point to the sun, linear between the beams of the map, so that
  /// the mean over a plane is that of the beams; below the clouds it is that of the beam through
  /// the point. It is for points in clear air and on the ground; see OpticalDepthToSun().
  [[nodiscard]] double Transmittance(const glm::dvec3& point) const;
  /// Returns the optical depth with this transmittance, at most 64.
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point) const {
    return -std::log(Transmittance(point));
  }

  /// Returns the mean transmittance to the sun around a point, over a block of about four beams and
  /// levels in each direction. Its mean over a plane of a periodic field is that of Transmittance()
  /// within 1e-3.
  [[nodiscard]] double TransmittanceAround(const glm::dvec3& point) const;

  /// Returns the mean over all nodes of the transmittance of whole beams. For a periodic field this
  /// is the direct transmittance to the ground.
  [[nodiscard]] double MeanTransmittance() const;

  /// Returns the memory of the map [bytes].
  [[nodiscard]] std::size_t bytes() const;
  /// Returns a hash of the map (FNV-1a, 64 bits).
  [[nodiscard]] std::uint64_t hash() const;

  /// The part of a beam between two levels in which it meets cloud.
  struct BeamPart {
    glm::dvec3 middle;
    double depth_above, depth_below;  // optical depths to the sun at its ends
    double area_m2;                   // of a level plane for which the beam stands
  };
  /// Calls visit(part) for the parts of all beams with cloud, in a fixed order. The sum of
  /// exp(-depth_above) - exp(-depth_below), times the area, is the light of unit downward flux that
  /// collides: exactly what the beams lose.
  template <typename Visit>
  void EachPart(const Visit& visit) const {
    for (int line = 0; line < lines(); ++line) EachPartOfLine(line, visit);
  }
  /// Returns the number of lines of beams, which can be visited one by one.
  [[nodiscard]] int lines() const { return nodes_[1]; }
  template <typename Visit>
  void EachPartOfLine(int line, const Visit& visit) const;

 private:
  /// Returns the optical depths of the beam of a node at a level and at the next one above.
  struct Ends {
    float below, above;
  };
  [[nodiscard]] Ends Between(std::size_t node, int level) const;
  [[nodiscard]] std::size_t StoredFrom(std::size_t node, int level) const;
  [[nodiscard]] float Depth(std::size_t node, std::size_t stored) const {
    if (stored == 0) return 0.0F;
    const auto value = static_cast<float>(value_[first_[node] + stored - 1]);
    return kUnit * value * value;
  }
  [[nodiscard]] bool HasCloud(std::size_t node, int level) const {
    const auto k = static_cast<std::size_t>(level);
    return (has_cloud_[node * words_ + k / 64] >> (k % 64) & 1U) != 0;
  }
  [[nodiscard]] std::size_t NodeOf(int column, int line) const {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(nodes_[0]) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] glm::dvec3 PointAt(int column, int line, double level) const;
  /// Returns a place in the map: node coordinates along u and v.
  [[nodiscard]] glm::dvec2 FootOf(const glm::dvec3& point) const {
    return (glm::dvec2(point) - (point.z - base_m_) * slope_ - low_) / cell_m_;
  }
  /// Adds the blocks along u of one line of blocks.
  void MakeBlocks(int line);
  [[nodiscard]] std::size_t BlockOf(int level, int column, int line) const {
    return (static_cast<std::size_t>(level) * static_cast<std::size_t>(blocks_[1]) +
            static_cast<std::size_t>(line)) *
               static_cast<std::size_t>(blocks_[0]) +
           static_cast<std::size_t>(column);
  }

  static constexpr double kDeepest = 64.0;
  static constexpr float kUnit = static_cast<float>(kDeepest / (65535.0 * 65535.0));

  glm::dvec3 to_sun_;
  glm::dvec2 slope_;  // of beams: (s_x, s_y) / s_z
  glm::dvec2 low_{0.0}, cell_m_{0.0};
  double base_m_ = 0.0, level_m_ = 1.0;
  bool is_periodic_ = true;
  std::array<int, 2> nodes_{};  // along u and v
  int levels_ = 0;
  std::size_t words_ = 0;                 // of 64 bits per node
  std::vector<std::uint64_t> has_cloud_;  // a bit for each pair of neighbouring levels
  std::vector<std::uint32_t> first_;      // of each node in value_
  std::vector<std::uint16_t> value_;      // of each bit that is set, from the highest one down
  std::array<int, 2> blocks_{};           // along u and v
  // Mean transmittances of blocks at every kBeamsOfBlock-th level, along u first.
  std::vector<std::uint16_t> block_;
};

/// Returns the optical depth from a point to the sun by steps in the field and the map ahead. At
/// points of cumulus weighted by extinction, the mean direct transmittance is within 1 % of that
/// by quadrature.
[[nodiscard]] double OpticalDepthToSun(const CloudField& field, const CloudSunMap& map,
                                       const glm::dvec3& point);

template <typename Visit>
void CloudSunMap::EachPartOfLine(int line, const Visit& visit) const {
  for (int column = 0; column < nodes_[0]; ++column) {
    const std::size_t node = NodeOf(column, line);
    for (int level = levels_ - 1; level >= 0; --level) {
      if (!HasCloud(node, level)) continue;
      const Ends ends = Between(node, level);
      visit(BeamPart{PointAt(column, line, level + 0.5), static_cast<double>(ends.above),
                     static_cast<double>(ends.below), cell_m_.x * cell_m_.y});
    }
  }
}

}  // namespace alpenglow::renderer
