// SPDX-License-Identifier: MIT
// This header provides cubic interpolation on a uniform grid: four neighbours and their Catmull-Rom
// weights.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "atmosphere/shared_glsl/shared_math.h"
#include "lut/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "lut/tables/cubic_taps.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::lut {

/// The neighbours of a position. At the ends of the grid the missing neighbour is extrapolated by
/// the parabola through the last three (BeyondEnd), and has weight 0 here.
struct CubicTaps {
  std::array<std::size_t, 4> node;
  std::array<float, 4> weight;
};

/// Returns the Catmull-Rom weights of the four neighbours at a fraction t in [0, 1] of the cell.
[[nodiscard]] inline std::array<float, 4> CatmullRom(float t) {
  return {shared::CubicWeight0(t), shared::CubicWeight1(t), shared::CubicWeight2(t),
          shared::CubicWeight3(t)};
}

/// Returns the taps at a position.
/// @param coordinate position in [0, 1] over n >= 2 nodes, clamped; linear between two nodes.
[[nodiscard]] inline CubicTaps TapsAt(double coordinate, int n) {
  const double position = std::clamp(coordinate, 0.0, 1.0) * (n - 1);
  const int cell = std::min(static_cast<int>(position), n - 2);
  const auto t = static_cast<float>(position - cell);
  if (n == 2) return {{0, 0, 1, 1}, {0.0F, 1.0F - t, t, 0.0F}};
  std::array<float, 4> weight = CatmullRom(t);
  if (cell == 0) {
    weight[1] += 3.0F * weight[0];
    weight[2] -= 3.0F * weight[0];
    weight[3] += weight[0];
    weight[0] = 0.0F;
  }
  if (cell == n - 2) {
    weight[2] += 3.0F * weight[3];
    weight[1] -= 3.0F * weight[3];
    weight[0] += weight[3];
    weight[3] = 0.0F;
  }
  CubicTaps taps{{}, weight};
  for (int i = 0; i < 4; ++i) {
    taps.node[static_cast<std::size_t>(i)] =
        static_cast<std::size_t>(std::clamp(cell - 1 + i, 0, n - 1));
  }
  return taps;
}

}  // namespace alpenglow::lut
