// SPDX-License-Identifier: MIT
// Gauss-Legendre rules, and adaptive integration built on them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <span>
#include <vector>

namespace alpenglow::atmosphere {

/// Nodes and weights on [0, 1]; integrates polynomials up to degree 2 n - 1 exactly.
struct GaussRule {
  std::vector<double> node;
  std::vector<double> weight;
};

inline constexpr int kMaxGaussNodes = 64;

/// The rule of n nodes, 1 <= n <= kMaxGaussNodes, nodes ascending.
/// Computed once by Newton's method on the Legendre recurrence
/// (Abramowitz and Stegun 25.4.29); nodes and weights are right to 1e-15.
[[nodiscard]] const GaussRule& GaussLegendre(int n);

/// Integral of a vector-valued function over consecutive panels, and an estimate of its error.
struct AdaptiveResult {
  std::vector<double> value;
  double error = 0.0;  // largest over components, relative to the largest component
  std::size_t panels = 0;
  bool converged = false;
};

/// Integrates f: double -> std::vector<double> (of `size` values) over [b0, b1], [b1, b2], ... of
/// ascending breakpoints. Panels are halved, worst first, until the difference between the 10-point
/// rule and its two halves, summed over panels, is below `relative_tolerance` times the largest
/// component of the integral.
template <typename Function>
[[nodiscard]] AdaptiveResult IntegrateAdaptively(const Function& f, std::size_t size,
                                                 std::span<const double> breakpoints,
                                                 double relative_tolerance,
                                                 std::size_t max_panels = 4096) {
  struct Panel {
    double low, high, error;
    std::vector<double> whole, halves;
    bool operator<(const Panel& other) const { return error < other.error; }
  };
  const GaussRule& rule = GaussLegendre(10);
  const auto apply = [&](double low, double high) {
    std::vector<double> sum(size, 0.0);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const std::vector<double> value = f(low + (high - low) * rule.node[i]);
      for (std::size_t k = 0; k < size; ++k) sum[k] += rule.weight[i] * (high - low) * value[k];
    }
    return sum;
  };
  const auto panel = [&](double low, double high, std::vector<double> whole) {
    const double middle = 0.5 * (low + high);
    Panel made{low, high, 0.0, std::move(whole), apply(low, middle)};
    const std::vector<double> right = apply(middle, high);
    for (std::size_t k = 0; k < size; ++k) {
      made.halves[k] += right[k];
      made.error = std::max(made.error, std::abs(made.halves[k] - made.whole[k]));
    }
    return made;
  };
  std::priority_queue<Panel> open;
  AdaptiveResult result;
  result.value.assign(size, 0.0);
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
    add(panel(worst.low, middle, apply(worst.low, middle)));
    add(panel(middle, worst.high, apply(middle, worst.high)));
    // Sums of many differences drift; the true sum of errors is never negative.
    error = std::max(error, 0.0);
  }
  result.panels = open.size();
  const double scale = largest();
  result.converged = error <= relative_tolerance * scale;
  result.error = scale > 0.0 ? error / scale : 0.0;
  return result;
}

}  // namespace alpenglow::atmosphere
