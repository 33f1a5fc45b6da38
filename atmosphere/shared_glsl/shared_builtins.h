// SPDX-License-Identifier: MIT
// The builtins of GLSL as C++, for float, double and long double (needed where a metre must be
// resolved at 1e8 m). There is no include guard and there are no includes: shared_math.h includes
// this file in alpenglow::shared, batch.h in the unnamed namespace of a kernel's functions.

using std::abs;
using std::cos;
using std::exp;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;
using std::tan;

inline long double atan(long double y, long double x) { return std::atan2(y, x); }
inline double atan(double y, double x) { return std::atan2(y, x); }
inline float atan(float y, float x) { return std::atan2(y, x); }
inline long double max(long double a, long double b) { return a < b ? b : a; }
inline double max(double a, double b) { return a < b ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline long double min(long double a, long double b) { return b < a ? b : a; }
inline double min(double a, double b) { return b < a ? b : a; }
inline float min(float a, float b) { return b < a ? b : a; }
inline long double select(bool condition, long double yes, long double no) {
  return condition ? yes : no;
}
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline float select(bool condition, float yes, float no) { return condition ? yes : no; }
