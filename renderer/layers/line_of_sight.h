// SPDX-License-Identifier: MIT
// Lines of sight through a stack of plane-parallel layers, cut at the interfaces. Depths are those
// after delta-M.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/layer_stack.h"

namespace alpenglow::renderer {

/// A depth within a layer, below its top.
struct LayerPlace {
  std::size_t layer;
  double depth;
};

/// @param depth  optical depth below the top of the stack, before delta-M, in [0, that of the
///   stack]; otherwise InputError.
[[nodiscard]] LayerPlace PlaceAtDepth(const LayerStack& stack, double depth);

/// A part of a line of sight within a layer.
struct LineSegment {
  std::size_t layer;
  double from, to;  // depths, from <= to
  double left;      // transmittance from its end that is nearer to the eye
};

/// Returns the parts of the line that sends light to an eye, beginning at the eye; at least one.
/// @param mu  in which the light travels: > 0 upwards, from the ground; never 0.
[[nodiscard]] std::vector<LineSegment> LineOfSight(const LayerStack& stack, const LayerPlace& eye,
                                                   double mu);

/// Returns the integral of a function that changes exponentially between two values.
/// @param rate  log(first / last) / length.
[[nodiscard]] double ExponentialIntegral(double first, double last, double rate, double length);

}  // namespace alpenglow::renderer
