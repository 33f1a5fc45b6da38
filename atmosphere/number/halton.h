// SPDX-License-Identifier: MIT
// Points that fill the unit interval evenly, the same in every run: Halton (1960), Numer. Math. 2,
// 84-90. Coordinates of a point in more dimensions are sequences of different prime bases.
#pragma once

namespace alpenglow::atmosphere {

/// Point number i >= 0 of the sequence of a base >= 2:
/// the digits of i mirrored at the point, in [0, 1).
[[nodiscard]] constexpr double Halton(int i, int base) {
  double value = 0.0, digit = 1.0;
  for (; i > 0; i /= base) value += (digit /= base) * (i % base);
  return value;
}

}  // namespace alpenglow::atmosphere
