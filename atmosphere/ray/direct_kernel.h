// SPDX-License-Identifier: MIT
// The loops of direct_scattering.h over the lanes of a ray, one table an instruction set.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/dialect/instruction_set.h"
#include "atmosphere/ray/direct_panels.h"
#include "atmosphere/ray/ray.h"

namespace alpenglow::atmosphere {

/// A Gauss rule of n nodes over the lanes of a group, and at each node the Legendre polynomial P_(n-1),
/// which turns the rule into one that gives 0 for polynomials of degree n - 2 and less.
struct DirectRule {
  alignas(64) std::array<float, kDirectLanes> node, weight, last_polynomial;
};

struct DirectRules {
  /// By number of nodes up to kMostFewNodes, the same in both halves of the lanes.
  std::array<DirectRule, kMostFewNodes + 1> few;
  DirectRule fourteen;
  DirectRule eight;  // of all lanes, in both halves: for columns along panels
};

/// Inputs from which light along a ray is found.
struct DirectWork {
  const DirectAir& air;
  const DirectRules& rules;
  const DirectRay& ray;
  const LaneLight* sunlight = nullptr;  // null: all that the planet lets through
};

struct DirectKernel {
  /// Light of all groups. With `last`, the same sums with each weight times the last polynomial.
  void (*scatter)(const DirectWork& work, ScatteredOnce<float>& scattered,
                  ScatteredOnce<float>* last);
  /// The nodes of all groups, dark ones too, after which rows are 0 up to whole SIMD lanes. Lanes 7
  /// and 15 of a group have weight 0. With `scattered`, the light of `scatter` too.
  void (*sample)(const DirectWork& work, RaySamples<float>& samples,
                 ScatteredOnce<float>* scattered);
  /// Columns along all panels, by integration of densities [km].
  ColumnSet<float> (*along)(const DirectAir& air, const DirectRules& rules, const DirectRay& ray);
};

ALPENGLOW_DECLARE_KERNEL(DirectKernel);

}  // namespace alpenglow::atmosphere
