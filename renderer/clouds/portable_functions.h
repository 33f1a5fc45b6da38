// SPDX-License-Identifier: MIT
// Elementary functions from +, -, *, / and bits of numbers. They give the same bits on every machine
// with IEEE arithmetic, which those of the C library do not; shapes of clouds use no others.
//
//   2^x     = 2^n (Taylor polynomial of 2^f to degree 8), |f| <= 1/2
//   log2 m  = (2 / ln 2) artanh((m - 1) / (m + 1)), to degree 11, m in [1/sqrt 2, sqrt 2)
//   cos, sin of turns: Taylor polynomials to degree 10 and 11 within an eighth of a turn
#pragma once

#include <bit>
#include <cstdint>
#include <glm/vec2.hpp>
#include <numbers>

namespace alpenglow::renderer {

/// Returns 2^x. Relative error below 1e-9. @param x  in [-1000, 1000].
[[nodiscard]] constexpr double PortableExp2(double x) {
  const auto truncated = static_cast<std::int64_t>(x < 0.0 ? x - 0.5 : x + 0.5);
  const double f = (x - static_cast<double>(truncated)) * std::numbers::ln2;
  // Factors instead of divisors: 1/8 to 1/1.
  constexpr double kInverse[] = {1.0 / 8, 1.0 / 7, 1.0 / 6, 1.0 / 5,
                                 1.0 / 4, 1.0 / 3, 1.0 / 2, 1.0};
  double sum = 1.0;
  for (const double inverse : kInverse) sum = 1.0 + sum * (f * inverse);
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(truncated + 1023) << 52U);
}

/// Returns the logarithm to base 2. Absolute error below 1e-9. @param x  > 0, not subnormal.
[[nodiscard]] constexpr double PortableLog2(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52U) - 1023);
  double m = std::bit_cast<double>((bits & 0xfffffffffffffU) | 0x3ff0000000000000U);
  if (m > std::numbers::sqrt2) {
    m *= 0.5;
    exponent += 1.0;
  }
  const double s = (m - 1.0) / (m + 1.0);
  double sum = 0.0;
  for (int degree = 11; degree >= 1; degree -= 2) sum = sum * s * s + 1.0 / degree;
  return exponent + 2.0 / std::numbers::ln2 * s * sum;
}

/// Returns x^y for x > 0. Relative error below 1e-8 while |y log2 x| < 10.
[[nodiscard]] constexpr double PortablePower(double x, double y) {
  return PortableExp2(y * PortableLog2(x));
}

/// Returns cosine and sine of an angle in turns. Absolute error below 1e-9. @param turns  within 1e6.
[[nodiscard]] constexpr glm::dvec2 PortableCircle(double turns) {
  const auto quarters = static_cast<std::int64_t>(4.0 * turns + (turns < 0.0 ? -0.5 : 0.5));
  const double a = (turns - 0.25 * static_cast<double>(quarters)) * 2.0 * std::numbers::pi;
  double cosine = 1.0, sine = 1.0;
  for (int degree = 10; degree >= 2; degree -= 2) {
    cosine = 1.0 - cosine * a * a / (degree * (degree - 1));
    sine = 1.0 - sine * a * a / (degree * (degree + 1));
  }
  sine *= a;
  switch (quarters & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

/// Returns 0 up to `low`, 1 from `high` on, and 3 t^2 - 2 t^3 between them; low < high.
[[nodiscard]] constexpr double SmoothRamp(double low, double high, double x) {
  const double t = x <= low ? 0.0 : x >= high ? 1.0 : (x - low) / (high - low);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace alpenglow::renderer
