// SPDX-License-Identifier: MIT
// Which way four samples are cut into two triangles.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace alpenglow {

/// Heights [m] of the 4 x 4 samples around a cell, row by row from the north-west. The cell's own
/// corners are 5 (north-west), 6, 9 and 10 (south-east).
using CellHeights = std::array<double, 16>;

/// Whether the middle of the diagonal from north-west to south-east is nearer than the other's to
/// the cubic height at the cell's centre; beside a void: false.
[[nodiscard]] inline bool FallingDiagonalFits(const CellHeights& around) {
  constexpr std::array<double, 4> kWeight{-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0};
  double centre = 0.0;
  for (std::size_t i = 0; i < around.size(); ++i)
    centre += kWeight[i / 4] * kWeight[i % 4] * around[i];
  const double falling = 0.5 * (around[5] + around[10]);
  const double rising = 0.5 * (around[9] + around[6]);
  return std::abs(falling - centre) < std::abs(rising - centre);
}

}  // namespace alpenglow
