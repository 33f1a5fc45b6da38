// SPDX-License-Identifier: MIT
// Numbers of values that repeat, as those of a periodic field do along x and y.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

namespace alpenglow::renderer {

/// Returns the number in [0, count) that differs from `index` by a multiple of `count` > 0.
template <std::signed_integral Integer>
[[nodiscard]] constexpr Integer PeriodicIndex(Integer index, Integer count) {
  if (index >= 0 && index < count) return index;  // nearly all are, and a division is slow
  const Integer rest = index % count;
  return rest < 0 ? rest + count : rest;
}

/// Returns the same for a whole number, which may lie outside of the range of integers. It is exact
/// for numbers below 2^52; greater ones have some number in [0, count).
[[nodiscard]] inline int PeriodicIndex(double whole, int count) {
  const double index = whole - count * std::floor(whole / count);
  return static_cast<int>(std::clamp(index, 0.0, count - 1.0));
}

}  // namespace alpenglow::renderer
