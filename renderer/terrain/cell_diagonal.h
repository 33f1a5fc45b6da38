// SPDX-License-Identifier: MIT
// Which way four samples are cut into two triangles, and the height on these.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace alpenglow::renderer {

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

/// Height [m] on the triangle over a place in the cell, `east` and `south` of its north-west corner
/// as shares of the cell; nothing beside a void.
[[nodiscard]] inline std::optional<double> HeightOnTriangles(const CellHeights& around, double east,
                                                             double south) {
  const double nw = around[5], ne = around[6], sw = around[9], se = around[10];
  const bool void_off_falling = std::isnan(ne) || std::isnan(sw);
  const bool void_off_rising = std::isnan(nw) || std::isnan(se);
  const bool falling = void_off_falling || (!void_off_rising && FallingDiagonalFits(around));
  double height = 0.0;
  if (falling) {
    height = east > south ? nw + east * (ne - nw) + south * (se - ne)
                          : nw + south * (sw - nw) + east * (se - sw);
  } else {
    height = east + south < 1.0 ? nw + east * (ne - nw) + south * (sw - nw)
                                : se + (1.0 - east) * (sw - se) + (1.0 - south) * (ne - se);
  }
  if (std::isnan(height)) return std::nullopt;
  return height;
}

}  // namespace alpenglow::renderer
