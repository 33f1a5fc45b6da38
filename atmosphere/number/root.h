// SPDX-License-Identifier: MIT
// The root of a continuous function between two points where its signs differ.
#pragma once

#include <cmath>

namespace alpenglow::atmosphere {

/// A point within `tolerance` of a root of f in [low, high]; f(low) and f(high) have different
/// signs or are 0. The tolerance must be larger than the rounding of the bounds. False position
/// with the Illinois weights (Dowell and Jarratt 1971, BIT 11, 168-174); a step that did not halve
/// the bracket is followed by a bisection, so the number of steps is bounded.
template <typename Function>
[[nodiscard]] double BracketedRoot(const Function& f, double low, double high, double tolerance) {
  double f_low = f(low);
  double f_high = f(high);
  if (f_low == 0.0) return low;
  if (f_high == 0.0) return high;
  bool bisect = false;
  int kept_side = 0;
  while (std::abs(high - low) > tolerance) {
    const double width = high - low;
    const double secant = high - f_high * (width / (f_high - f_low));
    const bool is_inside = secant > low && secant < high;  // false for 0/0 too
    const double middle = bisect || !is_inside ? 0.5 * (low + high) : secant;
    const double f_middle = f(middle);
    if (f_middle == 0.0) return middle;
    if ((f_middle < 0.0) == (f_low < 0.0)) {
      low = middle;
      f_low = f_middle;
      if (kept_side == +1) f_high *= 0.5;
      kept_side = +1;
    } else {
      high = middle;
      f_high = f_middle;
      if (kept_side == -1) f_low *= 0.5;
      kept_side = -1;
    }
    bisect = high - low > 0.5 * width;
  }
  return 0.5 * (low + high);
}

}  // namespace alpenglow::atmosphere
