// SPDX-License-Identifier: MIT
// Elevation of the horizon around every place of a terrain.
//
// For each of kHorizonAzimuths directions the heights are swept once, line by line from the far
// end. The horizon of a place over the terrain passed so far is the tangent to the upper convex
// hull of the line, kept as a stack, so that the cost of a place does not depend on the distance of
// its horizon (Timonen, Westerholm 2010, Computer Graphics Forum 29, 2). Lines run between the
// nodes of the grid; heights and horizons are interpolated linearly to and from them.
//
// The ground must be a single surface over the plane; of overhangs only the upper surface is used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/elevation/mesh.h"

namespace alpenglow::renderer {

/// Number of azimuths with horizons: in even steps counter-clockwise from east (x), seen from
/// above.
inline constexpr std::size_t kHorizonAzimuths = 16;
[[nodiscard]] double HorizonAzimuth(std::size_t i);

/// Sines of the horizon's elevation above the local horizontal.
using Horizons = std::array<float, kHorizonAzimuths>;

/// The two azimuths around a direction, and its position between them.
struct BetweenAzimuths {
  std::size_t before, after;
  double along;  // 0 at the first, 1 at the second

  explicit BetweenAzimuths(double azimuth_rad);
  [[nodiscard]] double Mean(const Horizons& horizons) const {
    const auto a = static_cast<double>(horizons[before]), b = static_cast<double>(horizons[after]);
    return a + along * (b - a);
  }
};

/// Immutable; safe to use from many threads.
class HorizonMap {
 public:
  /// Lowest stored sine: everything below it counts as ground.
  static constexpr float kLowest = -0.1F;

  /// @param planet_radius_m  determines the local vertical, which is the frame's z at the origin.
  HorizonMap(const HeightRaster& heights, double planet_radius_m);

  /// Interpolates bilinearly between nodes, and uses the rim for points beyond it. Resolution
  /// 1.7e-5.
  [[nodiscard]] Horizons At(const glm::dvec3& point) const;

  /// Returns the horizon towards one azimuth, node by node: a raster of sines instead of heights.
  [[nodiscard]] HeightRaster Towards(double azimuth_rad) const;
  /// Returns the grid of the nodes, without heights.
  [[nodiscard]] const HeightRaster& grid() const { return grid_; }

  /// Returns the packed sines, from kLowest (0) to 1 (65535): kHorizonAzimuths per node.
  [[nodiscard]] std::span<const std::uint16_t> packed() const { return sine_; }

  [[nodiscard]] std::size_t bytes() const { return sine_.size() * sizeof(std::uint16_t); }

 private:
  HeightRaster grid_;                // without heights
  std::vector<std::uint16_t> sine_;  // kHorizonAzimuths per node
};

}  // namespace alpenglow::renderer
