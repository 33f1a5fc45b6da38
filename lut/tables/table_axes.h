// SPDX-License-Identifier: MIT
// This header provides axes of tables: the sun's zenith cosine, dense where light changes fastest,
// at the terminator:
//
//   mu_s = centre + width sinh(low + (high - low) v),   v in [0, 1], up to mu_s = 1
//
// It also provides sizes of tables, checked before anything is allocated, and positions between
// texels: linear between two of them, and cubic on a uniform grid, with four neighbours and their
// Catmull-Rom weights. The shared texts cubic_taps.glsl and azimuth_cosine.glsl are read here as C++.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/shared_glsl/shared_math.h"
#include "lut/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "lut/tables/azimuth_cosine.glsl"
//
#include "lut/tables/cubic_taps.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::lut {

class SunAxis {
 public:
  SunAxis(double centre, double width, double lowest_mu_s)
      : centre_(centre),
        width_(width),
        low_(std::asinh((lowest_mu_s - centre) / width)),
        high_(std::asinh((1.0 - centre) / width)) {}

  /// Returns v in [0, 1] between the ends of the axis; outside of [0, 1] beyond them.
  [[nodiscard]] double Coordinate(double mu_s) const {
    return (std::asinh((mu_s - centre_) / width_) - low_) / (high_ - low_);
  }
  /// Returns the inverse of Coordinate, clamped to [-1, 1].
  [[nodiscard]] double MuS(double v) const {
    return std::clamp(centre_ + width_ * std::sinh(low_ + (high_ - low_) * v), -1.0, 1.0);
  }

  [[nodiscard]] double centre() const { return centre_; }
  [[nodiscard]] double width() const { return width_; }
  /// Return asinh((mu_s - centre) / width) at the ends.
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

 private:
  double centre_, width_, low_, high_;
};

/// Largest allowed table: 4 GiB.
inline constexpr std::uint64_t kLargestTable_bytes = std::uint64_t{1} << 32U;

/// One axis of a table: its name and number of texels.
struct TableAxis {
  std::string_view name;
  std::size_t texels;
  std::size_t fewest;  // shortest axis that can be interpolated
};

/// Returns the size of the floats of a table [bytes]. Throws InputError that names the table and
/// states the size if an axis is too short or the whole is above kLargestTable_bytes, and if the
/// medium has more bands than kMaxBands.
std::uint64_t RequireTableSize(std::string_view table, const std::vector<TableAxis>& axes,
                               std::size_t values_per_texel, const Medium& medium);

/// Returns the position of a texel's centre on its axis: 0 at the first texel, 1 at the last.
[[nodiscard]] constexpr double UnitOf(std::size_t index, std::size_t texels) {
  return static_cast<double>(index) / static_cast<double>(texels - 1);
}

/// A position between two neighbouring texels of an axis.
struct AxisPosition {
  std::size_t low = 0;    // index of the lower texel; low + 1 is on the axis, too
  float fraction = 0.0F;  // in [0, 1], 0 at the lower texel

  /// Returns the position on an axis.
  /// @param unit  0 at the centre of the first texel, 1 at that of the last; clamped, NaN to 0.
  static AxisPosition FromUnit(double unit, std::size_t texels) {
    const double clamped = unit > 0.0 ? (unit < 1.0 ? unit : 1.0) : 0.0;
    const double at = clamped * static_cast<double>(texels - 1);
    const auto low = static_cast<std::size_t>(at);
    if (low + 1 >= texels) return {texels - 2, 1.0F};
    return {low, static_cast<float>(at - static_cast<double>(low))};
  }

  /// Returns the weight of the lower (0) or the upper (1) of the two texels.
  [[nodiscard]] float Weight(std::size_t up) const { return up == 1 ? fraction : 1.0F - fraction; }
};

/// The neighbours of a position: four, or two and two of weight 0, which are not read.
struct CubicTaps {
  std::array<std::size_t, 4> node{};
  std::array<float, 4> weight{};
};

/// Returns the Catmull-Rom weights of the four neighbours at a fraction t in [0, 1] of the cell.
[[nodiscard]] inline std::array<float, 4> CatmullRom(float t) {
  return {shared::CubicWeight0(t), shared::CubicWeight1(t), shared::CubicWeight2(t),
          shared::CubicWeight3(t)};
}

/// Returns the taps at a position. At the ends of the grid the missing neighbour is extrapolated by
/// the parabola through the last three (BeyondEnd), and has weight 0 here.
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
