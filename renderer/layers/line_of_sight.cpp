// SPDX-License-Identifier: MIT
#include "renderer/layers/line_of_sight.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

LayerPlace PlaceAtDepth(const LayerStack& stack, double depth) {
  RequireInRange(depth, 0.0, stack.DepthAbove(stack.size()), "depth");
  std::size_t layer = 0;
  while (layer + 1 < stack.size() && depth >= stack.DepthAbove(layer + 1)) ++layer;
  const ScaledLayer& scaled = stack.scaled(layer);
  return {layer, std::min(scaled.scale * (depth - stack.DepthAbove(layer)), scaled.depth)};
}

std::vector<LineSegment> LineOfSight(const LayerStack& stack, const LayerPlace& eye, double mu) {
  std::vector<LineSegment> line;
  double left = 1.0;
  const auto add = [&](std::size_t layer, double from, double to) {
    line.push_back({layer, from, to, left});
    left *= std::exp(-(to - from) / std::abs(mu));
  };
  if (mu > 0.0) {
    for (std::size_t n = eye.layer; n < stack.size(); ++n) {
      add(n, n == eye.layer ? eye.depth : 0.0, stack.scaled(n).depth);
    }
  } else {
    for (std::size_t n = eye.layer + 1; n-- > 0;) {
      add(n, 0.0, n == eye.layer ? eye.depth : stack.scaled(n).depth);
    }
  }
  return line;
}

// From the larger end, so that nothing overflows.
double ExponentialIntegral(double first, double last, double rate, double length) {
  if (rate == 0.0) return first * length;
  return rate > 0.0 ? first * -std::expm1(-rate * length) / rate
                    : last * std::expm1(rate * length) / rate;
}

}  // namespace alpenglow::renderer
