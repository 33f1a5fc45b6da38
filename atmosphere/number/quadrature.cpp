// SPDX-License-Identifier: MIT
#include "atmosphere/number/quadrature.h"

#include <array>

#include "atmosphere/text/error.h"

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

}  // namespace alpenglow::atmosphere
