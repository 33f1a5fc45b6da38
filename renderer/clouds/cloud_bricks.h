// SPDX-License-Identifier: MIT
// The stored bricks of a field, for tables that sample the field elsewhere, such as textures.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// A view of the bricks of a field, which must outlive it.
class CloudField::StoredBricks {
 public:
  explicit StoredBricks(const CloudField& field) : bricks_(*field.bricks_) {}

  static constexpr int kVoxels = kSide;            // along each side of a brick
  static constexpr int kCornersOfSide = kCorners;  // likewise; neighbours share them
  static constexpr int kCornersOfBrick = kBrick;

  /// Returns the number of bricks along x, y and z.
  [[nodiscard]] const std::array<int, 3>& count() const { return bricks_.count; }
  /// Returns the number of bricks with values.
  [[nodiscard]] std::size_t stored() const { return bricks_.majorant_per_m.size(); }
  /// Returns the slot of each brick, x fastest, z slowest; -1 for bricks without values.
  [[nodiscard]] std::span<const std::int32_t> slots() const { return bricks_.slot; }
  /// Returns the distance of each brick to the nearest one with values, in bricks (Chebyshev).
  [[nodiscard]] std::span<const std::uint8_t> distances() const { return bricks_.distance; }
  /// Returns the depths at the corners of each slot [m], from kLeastCloudDepth_m on.
  [[nodiscard]] std::span<const std::uint8_t> depths() const { return bricks_.depth; }
  /// Returns the extinction at the same corners [1/m]; empty for fields of a shape.
  [[nodiscard]] std::span<const float> extinctions_per_m() const {
    return bricks_.extinction_per_m;
  }

 private:
  const Bricks& bricks_;
};

}  // namespace alpenglow::renderer
