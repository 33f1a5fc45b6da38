// SPDX-License-Identifier: MIT
#include "renderer/light/shaft_weights.h"

namespace alpenglow::renderer {
namespace {

/// (2 n + 1) P_n at the nodes of a Gauss rule on [0, 1].
using LegendreAtNodes = std::array<ShaftNodes, kMostShaftNodes>;  // [n][node]

LegendreAtNodes LegendreOf(int nodes) {
  LegendreAtNodes table{};
  const GaussRule& rule = GaussLegendre(nodes);
  for (std::size_t j = 0; j < rule.node.size(); ++j) {
    VisitLegendre(nodes, rule.node[j], [&](int n, double p) {
      table[static_cast<std::size_t>(n)][j] = (2.0 * n + 1.0) * p;
    });
  }
  return table;
}

const LegendreAtNodes& LegendreAt(int nodes) {
  static const auto kTables = [] {
    std::array<LegendreAtNodes, kMostShaftNodes + 1> tables{};
    for (int count = 1; count <= kMostShaftNodes; ++count)
      tables[static_cast<std::size_t>(count)] = LegendreOf(count);
    return tables;
  }();
  return kTables[static_cast<std::size_t>(nodes)];
}

}  // namespace

ShaftNodes FactorsFromMoments(int nodes, const ShaftNodes& moments) {
  const LegendreAtNodes& legendre = LegendreAt(nodes);
  const auto count = static_cast<std::size_t>(nodes);
  ShaftNodes light{};
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t j = 0; j < count; ++j) light[j] += legendre[n][j] * moments[n];
  }
  return light;
}

SunlitPiece Clipped(const SunlitPiece& piece, double begin_m, double end_m) {
  const double begin = std::clamp(begin_m, piece.begin_m, piece.end_m);
  const double end = std::clamp(end_m, piece.begin_m, piece.end_m);
  const double slope = (piece.end_x - piece.begin_x) / piece.length_m();
  return {begin, end, piece.begin_x + slope * (begin - piece.begin_m),
          piece.begin_x + slope * (end - piece.begin_m)};
}

}  // namespace alpenglow::renderer
