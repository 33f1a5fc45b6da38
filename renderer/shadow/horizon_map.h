// SPDX-License-Identifier: MIT
// How high the horizon stands around every place of a terrain.
//
// For each of kAzimuths directions the heights are swept once, line by line from the far end: what
// a place sees of the ground behind it is the tangent to the upper convex hull of the line so far,
// kept as a stack, so that a place costs the same however far it looks (Timonen, Westerholm 2010,
// Computer Graphics Forum 29, 2). Lines run between the nodes of the grid; heights and horizons are
// interpolated linearly to and from them.
//
// For ground that is one surface over the plane; of overhangs the upper surface counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

/// Directions around the vertical that horizons are kept for: counter-clockwise from east (x) in
/// even steps, seen from above.
inline constexpr std::size_t kHorizonAzimuths = 16;
[[nodiscard]] double HorizonAzimuth(std::size_t i);

/// Sines of the horizon's elevation over the local horizontal.
using Horizons = std::array<float, kHorizonAzimuths>;

/// The two azimuths that a direction lies between, and where.
struct BetweenAzimuths {
  std::size_t before, after;
  double along;  // 0 at the first, 1 at the second

  explicit BetweenAzimuths(double azimuth_rad);
  [[nodiscard]] double Mean(const Horizons& horizons) const {
    const auto a = static_cast<double>(horizons[before]), b = static_cast<double>(horizons[after]);
    return a + along * (b - a);
  }
};

/// Immutable; safe to ask from many threads.
class HorizonMap {
 public:
  /// Below this sine no horizon is kept: all that is lower counts as ground.
  static constexpr float kLowest = -0.1F;

  /// @param planet_radius_m  for the direction of the vertical, the frame's z at the origin.
  HorizonMap(const HeightRaster& heights, double planet_radius_m);

  /// Bilinear between nodes; at the rim beyond it. In steps of 1.7e-5.
  [[nodiscard]] Horizons At(const glm::dvec3& point) const;

  /// Towards one azimuth, node by node: sines in the place of heights.
  [[nodiscard]] HeightRaster Towards(double azimuth_rad) const;
  /// The nodes, without heights.
  [[nodiscard]] const HeightRaster& grid() const { return grid_; }

  /// Sines from kLowest, 0, to 1, 65535: kHorizonAzimuths a node.
  [[nodiscard]] std::span<const std::uint16_t> packed() const { return sine_; }

  [[nodiscard]] std::size_t bytes() const { return sine_.size() * sizeof(std::uint16_t); }

 private:
  HeightRaster grid_;                // without heights
  std::vector<std::uint16_t> sine_;  // kHorizonAzimuths a node
};

}  // namespace alpenglow::renderer
