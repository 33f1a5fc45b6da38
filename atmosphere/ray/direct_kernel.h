// SPDX-License-Identifier: MIT
// The loops of direct_scattering.h over the lanes of a ray, one table an instruction set.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/dialect/instruction_set.h"
#include "atmosphere/ray/direct_air.h"
#include "atmosphere/ray/direct_panels.h"
#include "atmosphere/ray/optical_depth.h"
#include "atmosphere/ray/ray_samples.h"

namespace alpenglow {

inline constexpr std::size_t kDirectLanes = 16;

/// A Gauss rule of n nodes over the lanes of a group, and at each node the Legendre polynomial P_(n-1),
/// which turns the rule into one that gives 0 for polynomials of degree n - 2 and less.
struct DirectRule {
  alignas(64) std::array<float, kDirectLanes> node, weight, last_polynomial;
};

struct DirectRules {
  DirectRule seven, fourteen;
};

struct DirectKernel {
  /// Light of all groups, which must be lit. With `last`, the same sums with each weight times the
  /// last polynomial.
  void (*scatter)(const DirectAir& air, const DirectRules& rules, const DirectRay& ray,
                  ScatteredOnce<float>& scattered, ScatteredOnce<float>* last);
  /// The nodes of all groups, dark ones too, after which rows are 0 up to whole SIMD lanes. Lanes 7
  /// and 15 of a group have weight 0.
  void (*sample)(const DirectAir& air, const DirectRules& rules, const DirectRay& ray,
                 RaySamples<float>& samples);
};

ALPENGLOW_DECLARE_KERNEL(DirectKernel);

}  // namespace alpenglow
