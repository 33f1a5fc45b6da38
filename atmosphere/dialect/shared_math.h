// SPDX-License-Identifier: MIT
// The builtins of GLSL that shared texts use, for double and float. SIMD batches bring their own
// overloads (xsimd), found by argument-dependent lookup.
#pragma once

#include <cmath>

namespace alpenglow::shared {

using std::abs;
using std::cos;
using std::exp;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;
using std::tan;

inline double max(double a, double b) { return a < b ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline double min(double a, double b) { return b < a ? b : a; }
inline float min(float a, float b) { return b < a ? b : a; }
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline float select(bool condition, float yes, float no) { return condition ? yes : no; }

}  // namespace alpenglow::shared
