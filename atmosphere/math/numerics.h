// SPDX-License-Identifier: MIT
// Numerical methods: bracketed roots, Gauss-Legendre rules with adaptive integration, small dense
// systems of linear equations, Halton sequences and the hash FNV-1a.
//
// Halton sequences fill the unit interval evenly and are the same in every run: Halton (1960),
// Numer. Math. 2, 84-90. The coordinates of a point in more dimensions are sequences of different
// prime bases.
//
// FNV-1a, 64 bits (Fowler, Noll, Vo; draft-eastlake-fnv), over little-endian bytes; -0 is read as
// 0.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace alpenglow::atmosphere {

/// Returns the value, limited to finite half floats (-65504 to 65504).
[[nodiscard]] inline float WithinHalf(float value) {
  return std::clamp(value, -65504.0F, 65504.0F);
}

/// Returns a point within `tolerance` of a root of the continuous function f in [low, high]; f(low)
/// and f(high) have different signs or are 0. The tolerance must be larger than the rounding of the
/// bounds. The method is false position with the Illinois weights (Dowell and Jarratt 1971, BIT 11,
/// 168-174). A step that did not halve the bracket is followed by a bisection, so the number of
/// steps is bounded.
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

/// Nodes and weights on [0, 1]; the rule integrates polynomials up to degree 2 n - 1 exactly.
struct GaussRule {
  std::vector<double> node;
  std::vector<double> weight;
};

inline constexpr int kMaxGaussNodes = 64;

/// Returns the rule of n nodes, 1 <= n <= kMaxGaussNodes, nodes ascending. Rules are computed once
/// by Newton's method on the Legendre recurrence (Abramowitz and Stegun 25.4.29); nodes and weights
/// are accurate to 1e-15.
[[nodiscard]] const GaussRule& GaussLegendre(int n);

/// Integral of a vector-valued function over consecutive panels, and an estimate of its error.
/// @tparam Values  std::vector<double>, or std::array<double, n>, which needs no allocation
template <typename Values>
struct AdaptiveResult {
  Values value;
  double error = 0.0;  // largest over components, relative to the largest component
  std::size_t panels = 0;
  bool converged = false;
};

/// The 10-point rule: integrates f: double -> std::vector<double> (of `size` values) or
/// std::array<double, size> over one panel.
template <typename Function>
class TenPointRule {
 public:
  using Values = std::invoke_result_t<Function, double>;

  TenPointRule(const Function& f, std::size_t size) : f_(f), size_(size) {}

  [[nodiscard]] Values operator()(double low, double high) const {
    Values sum = Zeros();
    for (std::size_t i = 0; i < rule_.node.size(); ++i) {
      const Values value = f_(low + (high - low) * rule_.node[i]);
      for (std::size_t k = 0; k < size_; ++k) sum[k] += rule_.weight[i] * (high - low) * value[k];
    }
    return sum;
  }

  [[nodiscard]] Values Zeros() const {
    if constexpr (std::is_same_v<Values, std::vector<double>>) return Values(size_, 0.0);
    return Values{};
  }

 private:
  const Function& f_;
  std::size_t size_;
  const GaussRule& rule_ = GaussLegendre(10);
};

/// Integrates over the panels [b0, b1], [b1, b2], ... of ascending breakpoints. Panels are halved,
/// worst first, until the difference between the rule of a panel and those of its halves, summed
/// over panels, is below `relative_tolerance` times the largest component of the integral.
/// @param apply  returns the integral over a panel, given both ends, by a rule.
/// @param zeros  the integral over no panel.
template <typename Apply, typename Values>
[[nodiscard]] AdaptiveResult<Values> IntegratePanels(const Apply& apply, const Values& zeros,
                                                     std::span<const double> breakpoints,
                                                     double relative_tolerance,
                                                     std::size_t max_panels = 4096) {
  struct Panel {
    double low, high, error;
    Values left, right, halves;  // integrals over the first half, the second, and their sum
    bool operator<(const Panel& other) const { return error < other.error; }
  };
  const std::size_t size = zeros.size();
  const auto panel = [&](double low, double high, const Values& whole) {
    const double middle = 0.5 * (low + high);
    Panel made{low, high, 0.0, apply(low, middle), apply(middle, high), zeros};
    for (std::size_t k = 0; k < size; ++k) {
      made.halves[k] = made.left[k] + made.right[k];
      made.error = std::max(made.error, std::abs(made.halves[k] - whole[k]));
    }
    return made;
  };
  std::priority_queue<Panel> open;
  AdaptiveResult<Values> result;
  result.value = zeros;
  double error = 0.0;
  const auto add = [&](Panel made) {
    for (std::size_t k = 0; k < size; ++k) result.value[k] += made.halves[k];
    error += made.error;
    open.push(std::move(made));
  };
  for (std::size_t i = 0; i + 1 < breakpoints.size(); ++i) {
    if (breakpoints[i] < breakpoints[i + 1]) {
      add(panel(breakpoints[i], breakpoints[i + 1], apply(breakpoints[i], breakpoints[i + 1])));
    }
  }
  const auto largest = [&] {
    double most = 0.0;
    for (const double value : result.value) most = std::max(most, std::abs(value));
    return most;
  };
  while (!open.empty() && error > relative_tolerance * largest() && open.size() < max_panels) {
    const Panel worst = open.top();
    open.pop();
    for (std::size_t k = 0; k < size; ++k) result.value[k] -= worst.halves[k];
    error -= worst.error;
    const double middle = 0.5 * (worst.low + worst.high);
    add(panel(worst.low, middle, worst.left));
    add(panel(middle, worst.high, worst.right));
    // A sum of many differences drifts; the true sum of errors is never negative.
    error = std::max(error, 0.0);
  }
  result.panels = open.size();
  const double scale = largest();
  result.converged = error <= relative_tolerance * scale;
  result.error = scale > 0.0 ? error / scale : 0.0;
  return result;
}

/// Integrates f: double -> std::vector<double> (of `size` values) or std::array<double, size> by
/// the 10-point rule (IntegratePanels).
template <typename Function>
[[nodiscard]] auto IntegrateAdaptively(const Function& f, std::size_t size,
                                       std::span<const double> breakpoints,
                                       double relative_tolerance, std::size_t max_panels = 4096) {
  const TenPointRule<Function> rule(f, size);
  return IntegratePanels(rule, rule.Zeros(), breakpoints, relative_tolerance, max_panels);
}

/// Solves a symmetric positive definite system by Cholesky's factorisation. Throws InternalError if
/// a pivot is not positive.
/// @param matrix  n x n, row-major; the lower triangle is read. n = right_side.size().
[[nodiscard]] std::vector<double> SolvePositiveDefinite(std::vector<double> matrix,
                                                        std::vector<double> right_side);

/// Returns point number i >= 0 of the sequence of a base >= 2: the digits of i mirrored at the
/// radix point, in [0, 1).
[[nodiscard]] constexpr double Halton(int i, int base) {
  double value = 0.0, digit = 1.0;
  for (; i > 0; i /= base) value += (digit /= base) * (i % base);
  return value;
}

/// FNV-1a hash of 64 bits (Fowler, Noll, Vo).
class Fnv1a {
 public:
  /// Adds bytes without their number.
  void AddBytes(std::string_view bytes) {
    for (const char byte : bytes) AddByte(static_cast<unsigned char>(byte));
  }
  void Add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte, word >>= 8) AddByte(word & 0xffU);
  }
  void Add(double value) { Add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  void Add(const std::vector<double>& values) {
    Add(std::uint64_t{values.size()});
    for (const double value : values) Add(value);
  }
  void Add(const std::string& text) {
    Add(std::uint64_t{text.size()});
    for (const char letter : text) Add(std::uint64_t{static_cast<unsigned char>(letter)});
  }

  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  void AddByte(std::uint64_t byte) { hash_ = (hash_ ^ byte) * 0x100000001b3U; }

  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

}  // namespace alpenglow::atmosphere
