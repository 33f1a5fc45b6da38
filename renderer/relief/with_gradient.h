// SPDX-License-Identifier: MIT
// This header provides numbers that carry their derivatives by two coordinates (forward automatic
// differentiation): a function that is written for any number type then also returns its gradient.
//
// Constants have the gradient 0. At a kink (min, max, abs, select) the gradient is that of the
// chosen side.
#pragma once

#include <cmath>
#include <type_traits>

namespace alpenglow::renderer {

template <typename Real>
struct WithGradient {
  Real value{}, east{}, north{};  // value and its derivatives

  WithGradient() = default;
  template <typename Constant, typename = std::enable_if_t<std::is_arithmetic_v<Constant>>>
  explicit WithGradient(Constant constant) : value(static_cast<Real>(constant)) {}
  WithGradient(Real of_value, Real by_east, Real by_north)
      : value(of_value), east(by_east), north(by_north) {}

  /// Returns a function of this number from its value and its derivative.
  [[nodiscard]] WithGradient Mapped(Real of_value, Real derivative) const {
    return {of_value, derivative * east, derivative * north};
  }

  friend WithGradient operator-(const WithGradient& a) { return {-a.value, -a.east, -a.north}; }
  friend WithGradient operator+(const WithGradient& a, const WithGradient& b) {
    return {a.value + b.value, a.east + b.east, a.north + b.north};
  }
  friend WithGradient operator-(const WithGradient& a, const WithGradient& b) {
    return {a.value - b.value, a.east - b.east, a.north - b.north};
  }
  friend WithGradient operator*(const WithGradient& a, const WithGradient& b) {
    return {a.value * b.value, a.east * b.value + a.value * b.east,
            a.north * b.value + a.value * b.north};
  }
  friend WithGradient operator/(const WithGradient& a, const WithGradient& b) {
    const Real inverse = Real(1) / b.value;
    const Real ratio = a.value * inverse;
    return {ratio, (a.east - ratio * b.east) * inverse, (a.north - ratio * b.north) * inverse};
  }
  WithGradient& operator+=(const WithGradient& b) { return *this = *this + b; }
  WithGradient& operator-=(const WithGradient& b) { return *this = *this - b; }

  friend bool operator<(const WithGradient& a, const WithGradient& b) { return a.value < b.value; }
  friend bool operator>(const WithGradient& a, const WithGradient& b) { return a.value > b.value; }

  friend WithGradient min(const WithGradient& a, const WithGradient& b) { return b < a ? b : a; }
  friend WithGradient max(const WithGradient& a, const WithGradient& b) { return a < b ? b : a; }
  friend WithGradient abs(const WithGradient& a) { return a.value < Real(0) ? -a : a; }
  friend WithGradient select(bool condition, const WithGradient& yes, const WithGradient& no) {
    return condition ? yes : no;
  }
  friend WithGradient sqrt(const WithGradient& a) {
    const Real root = std::sqrt(a.value);
    return a.Mapped(root, Real(0.5) / root);
  }
  friend WithGradient exp(const WithGradient& a) {
    const Real power = std::exp(a.value);
    return a.Mapped(power, power);
  }
  friend WithGradient log(const WithGradient& a) {
    return a.Mapped(std::log(a.value), Real(1) / a.value);
  }
};

inline double ValueOf(double number) { return number; }
inline float ValueOf(float number) { return number; }
template <typename Real>
[[nodiscard]] Real ValueOf(const WithGradient<Real>& number) {
  return number.value;
}

}  // namespace alpenglow::renderer
