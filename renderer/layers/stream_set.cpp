// SPDX-License-Identifier: MIT
#include "renderer/layers/stream_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {

std::vector<double> AssociatedLegendre(int m, int degree, double mu) {
  std::vector<double> lambda(static_cast<std::size_t>(degree) + 1, 0.0);
  if (m > degree) return lambda;
  double value = 1.0;
  const double sine = std::sqrt(std::max((1.0 - mu) * (1.0 + mu), 0.0));
  for (int k = 1; k <= m; ++k) value *= std::sqrt((2.0 * k - 1.0) / (2.0 * k)) * sine;
  double before = 0.0;
  for (int l = m; l <= degree; ++l) {
    lambda[static_cast<std::size_t>(l)] = value;
    const auto root = [m](int k) { return std::sqrt(static_cast<double>(k * k - m * m)); };
    const double next = ((2.0 * l + 1.0) * mu * value - root(l) * before) / root(l + 1);
    before = value;
    value = next;
  }
  return lambda;
}

StreamSet::StreamSet(int streams) : streams_(streams) {
  if (streams < 2 || streams > kMostStreams || streams % 2 != 0) {
    throw InputError(
        fmt::format("streams is {}; it must be even and lie in [2, {}]", streams, kMostStreams));
  }
  const GaussRule& rule = GaussLegendre(streams / 2);
  mu_ = rule.node;
  weight_ = rule.weight;
  for (int m = 0; m < streams; ++m) {
    for (const double mu : mu_) legendre_.push_back(AssociatedLegendre(m, streams - 1, mu));
  }
}

}  // namespace alpenglow::renderer
