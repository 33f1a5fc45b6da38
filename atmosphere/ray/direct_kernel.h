// SPDX-License-Identifier: MIT
// Kernels of direct_scattering.h: loops over the lanes of a ray, one table per instruction set.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/ray/direct_panels.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/shared_glsl/instruction_set.h"

namespace alpenglow::atmosphere {

/// A Gauss rule of n nodes over the lanes of a group, and at each node the Legendre polynomial
/// P_(n-1). With this factor the rule gives 0 for polynomials of degree n - 2 and less.
struct DirectRule {
  alignas(64) std::array<float, kDirectLanes> node, weight, last_polynomial;
};

struct DirectRules {
  /// Rules by number of nodes up to kMostFewNodes, repeated in both halves of the lanes.
  std::array<DirectRule, kMostFewNodes + 1> few;
  DirectRule fourteen;
  DirectRule eight;  // over all lanes, in both halves: for columns along panels
};

/// Inputs for the light along a ray.
struct DirectWork {
  const DirectAir& air;
  const DirectRules& rules;
  const DirectRay& ray;
  const LaneLight* sunlight = nullptr;  // null: unshadowed except by the planet
};

struct DirectKernel {
  /// Sums the light of all groups. With `last`, the sums are also computed with each weight times
  /// the last polynomial.
  void (*scatter)(const DirectWork& work, ScatteredOnce<float>& scattered,
                  ScatteredOnce<float>* last);
  /// Writes the nodes of all groups, including dark ones; the rest of each row is 0 up to a
  /// multiple of the SIMD lanes. Lanes 7 and 15 of a group have weight 0. With `scattered`, the
  /// light of `scatter` is computed too.
  void (*sample)(const DirectWork& work, RaySamples<float>& samples,
                 ScatteredOnce<float>* scattered);
  /// Returns columns along all panels, by integration of densities [km].
  ColumnSet<float> (*along)(const DirectAir& air, const DirectRules& rules, const DirectRay& ray);
};

ALPENGLOW_DECLARE_KERNEL(DirectKernel);

}  // namespace alpenglow::atmosphere
