// SPDX-License-Identifier: MIT
// Sunlight at the Gauss nodes of a panel of a ray, where terrain shades parts of it: the factors
// that aerial_perspective.h describes.
//
// A panel is any stretch of a ray with a map from v in [0, 1] to the distance from the eye [m]:
//
//   begin_m, end_m       its ends
//   DistanceAt(v)        the map
//   CoordinateAt(d)      its inverse
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "atmosphere/number/quadrature.h"
#include "renderer/layer.h"
#include "renderer/shadow/sunlit_path.h"

namespace alpenglow::renderer {

inline constexpr int kMostShaftNodes = 16;

/// By node or by degree; the rest is 0.
using ShaftNodes = std::array<double, kMostShaftNodes>;

/// Calls visit(n, P_n) for n < count at v, Legendre polynomials on [0, 1].
template <typename Visit>
void VisitLegendre(int count, double v, const Visit& visit) {
  const double x = 2.0 * v - 1.0;
  double last = 0.0;
  double p = 1.0;
  for (int n = 0; n < count; ++n) {
    visit(n, p);
    const double next = ((2.0 * n + 1.0) * x * p - n * last) / (n + 1.0);
    last = p;
    p = next;
  }
}

/// Factors of the nodes of a Gauss rule on [0, 1] from the moments of sunlight.
/// @param nodes  in [1, kMostShaftNodes].
[[nodiscard]] ShaftNodes FactorsFromMoments(int nodes, const ShaftNodes& moments);

/// The part of a piece between two distances; nothing left of it has no length.
[[nodiscard]] SunlitPiece Clipped(const SunlitPiece& piece, double begin_m, double end_m);

/// Adds the moments of a piece of sunlight, which lies within the panel. Eight nodes are exact for
/// full light, and half shade is smooth.
template <typename Panel>
void AddMoments(const Panel& panel, const SunlitPiece& piece, int nodes, ShaftNodes& moments) {
  static const GaussRule& rule = GaussLegendre(8);
  const double from = panel.CoordinateAt(piece.begin_m);
  const double to = panel.CoordinateAt(piece.end_m);
  const bool full = piece.begin_x >= 1.0 && piece.end_x >= 1.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double v = from + (to - from) * rule.node[i];
    double light = std::abs(to - from) * rule.weight[i];
    if (!full) {
      const double share = (panel.DistanceAt(v) - piece.begin_m) / piece.length_m();
      light *= SunlightOverEdge(piece.begin_x + share * (piece.end_x - piece.begin_x));
    }
    VisitLegendre(nodes, v,
                  [&](int n, double p) { moments[static_cast<std::size_t>(n)] += light * p; });
  }
}

/// Sunlight at the nodes of a panel, as factors of their weights.
template <typename Panel>
[[nodiscard]] ShaftNodes SunlightAtNodes(const Panel& panel, int nodes, const SunlitPath& sunlit) {
  ShaftNodes moments{};
  for (const SunlitPiece& piece : sunlit) {
    const SunlitPiece within = Clipped(piece, panel.begin_m, panel.end_m);
    if (within.length_m() > 0.0) AddMoments(panel, within, nodes, moments);
  }
  return FactorsFromMoments(nodes, moments);
}

/// Returns whether a piece in full light covers all of a panel.
template <typename Panel>
[[nodiscard]] bool LightUnbroken(const Panel& panel, const SunlitPath& sunlit) {
  return std::any_of(sunlit.begin(), sunlit.end(), [&](const SunlitPiece& piece) {
    return piece.begin_x >= 1.0 && piece.end_x >= 1.0 && piece.begin_m <= panel.begin_m &&
           piece.end_m >= panel.end_m;
  });
}

}  // namespace alpenglow::renderer
