// SPDX-License-Identifier: MIT
// Vertical optical depth and cover, of fields and of shapes that are not stored yet.
//
// A shape with one free parameter is adjusted to a cover by halving an interval of the parameter.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// Vertical optical depths of columns on a square grid over one period.
struct OpticalDepthMap {
  int side = 0;                      // columns along x and y
  double spacing_m = 0.0;            // between columns
  std::vector<float> optical_depth;  // x fastest
};

/// Returns the optical depths of a periodic field, by the midpoint rule with steps of half a voxel.
[[nodiscard]] OpticalDepthMap VerticalOpticalDepths(const CloudField& field, int side);

/// Returns the fraction of columns with a greater optical depth.
[[nodiscard]] double CoverOf(const OpticalDepthMap& map, double least_optical_depth);

/// The depth of a shape with a parameter [m], as CloudShape::SignedDepth_m.
using DepthWithParameter = std::function<double(const glm::dvec3& point, double parameter)>;

/// The cover to which a shape is adjusted.
struct WantedCover {
  double cover;                // in [0, 1]
  double least_optical_depth;  // of a covered column
  double low, high;            // interval of the parameter; the cover does not decrease with it
};

/// Returns the parameter at which a shape has a cover, from columns about 160 m apart; the nearer end
/// of the interval if no parameter has it. The result does not depend on the number of threads.
[[nodiscard]] double ParameterForCover(const CloudLattice& lattice, const CloudMatter& matter,
                                       const DepthWithParameter& depth_m,
                                       const WantedCover& wanted);

}  // namespace alpenglow::renderer
