// SPDX-License-Identifier: MIT
// Kernels of direct_scattering.h: loops over the lanes of a ray, one table per instruction set.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/ray/direct_panels.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/shared_glsl/instruction_set.h"

namespace alpenglow::atmosphere {

/// A Gauss rule of n nodes over the lanes of a group.
struct DirectRule {
  alignas(64) std::array<float, kDirectLanes> node, weight;
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
  /// Sums the light of all groups.
  void (*scatter)(const DirectWork& work, ScatteredOnce<float>& scattered);
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
