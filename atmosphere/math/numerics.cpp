// SPDX-License-Identifier: MIT
#include "atmosphere/math/numerics.h"

#include <array>
#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

GaussRule ComputeRule(int n) {
  GaussRule rule;
  rule.node.resize(static_cast<std::size_t>(n));
  rule.weight.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    long double x = std::cos(3.14159265358979323846L * (static_cast<long double>(i) + 0.75L) /
                             (static_cast<long double>(n) + 0.5L));
    long double derivative = 0;
    for (int step = 0; step < 20; ++step) {
      long double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const long double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (x * p1 - p0) / (x * x - 1);
      const long double move = p1 / derivative;
      x -= move;
      if (std::abs(move) < 1e-19L) break;
    }
    const auto slot = static_cast<std::size_t>(n - 1 - i);
    rule.node[slot] = static_cast<double>((1 + x) / 2);
    rule.weight[slot] = static_cast<double>(1 / ((1 - x * x) * derivative * derivative));
  }
  return rule;
}

}  // namespace

const GaussRule& GaussLegendre(int n) {
  ALPENGLOW_ENSURE(n, >=, 1);
  ALPENGLOW_ENSURE(n, <=, kMaxGaussNodes);
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> all;
    for (int count = 1; count <= kMaxGaussNodes; ++count) all.push_back(ComputeRule(count));
    return all;
  }();
  return rules[static_cast<std::size_t>(n - 1)];
}

std::vector<double> SolvePositiveDefinite(std::vector<double> matrix,
                                          std::vector<double> right_side) {
  const std::size_t n = right_side.size();
  ALPENGLOW_ENSURE(matrix.size(), ==, n * n);
  std::vector<double>& l = matrix;
  std::vector<double>& x = right_side;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      for (std::size_t i = j; i < n; ++i) l[i * n + j] -= l[i * n + k] * l[j * n + k];
    }
    ALPENGLOW_ENSURE(l[j * n + j], >, 0.0);
    const double pivot = std::sqrt(l[j * n + j]);
    for (std::size_t i = j; i < n; ++i) l[i * n + j] /= pivot;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
  return x;
}

}  // namespace alpenglow::atmosphere
