// SPDX-License-Identifier: MIT
// This header completes values of the points of a path that only some of them have.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Interpolates values from the known ones, linearly along the path, and evenly where the path
/// stands still. At least one must be known.
/// @param way_m  of each point: distance along the path, not decreasing.
/// @param beyond  (at, neighbour, next) extrapolates past the first and the last known value; the
///     neighbour is the nearest known one and `next` the one after it, if there is one.
template <typename Beyond>
[[nodiscard]] std::vector<double> CompletedAlong(const std::vector<double>& way_m,
                                                 const std::vector<std::optional<double>>& known,
                                                 const Beyond& beyond) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i]) at.push_back(i);
  }
  std::vector<double> values;
  std::size_t right = 0;  // the first known index from here on
  for (std::size_t i = 0; i < known.size(); ++i) {
    while (right < at.size() && at[right] < i) ++right;
    if (known[i]) {
      values.push_back(*known[i]);
    } else if (right == 0) {
      values.push_back(beyond(i, at.front(), at[std::min<std::size_t>(1, at.size() - 1)]));
    } else if (right == at.size()) {
      values.push_back(beyond(i, at.back(), at[at.size() - std::min<std::size_t>(2, at.size())]));
    } else {
      const std::size_t a = at[right - 1], b = at[right];
      const double step_m = way_m[b] - way_m[a];
      const double share = step_m > 0.0 ? (way_m[i] - way_m[a]) / step_m
                                        : static_cast<double>(i - a) / static_cast<double>(b - a);
      values.push_back(*known[a] + share * (*known[b] - *known[a]));
    }
  }
  return values;
}

}  // namespace alpenglow::renderer
