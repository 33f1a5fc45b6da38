// SPDX-License-Identifier: MIT
// This header generates random test cases of lamps beside rays with reference results, and provides
// rules of the literature that integrate the same light.
#pragma once

#include "atmosphere/lamp/airlight.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Properties that a set of test cases shares.
struct LampTestKind {
  double g = 0.8;                                                   // Henyey-Greenstein
  double scale_height_m = std::numeric_limits<double>::infinity();  // of the fog
  bool beam = false;                                                // a cone, not isotropic
  bool through = false;    // the ray passes through the lamp, a ball of 0.1 m
  bool clear_air = false;  // adds molecules and aerosol to the fog
};

/// A lamp, a ray and the air around them.
struct LampTestCase {
  LampAir air;
  Lamp lamp;
  LampSegment segment;
  double truth = 0.0;     // reference result of reference::AirlightAlong
  bool converged = true;  // whether the reference converged
};

/// Returns test case i >= 1: extinction 1e-4 to 0.1 per metre at the lowest point, distance of the
/// lamp from the ray 0.1 to 100 m, segments of 10 to 1000 m, and the lamp beside, before or behind
/// the segment.
[[nodiscard]] LampTestCase LampTestCaseNumber(int i, const LampTestKind& kind);

/// Rule for integrating the light of a lamp along a ray, in one band.
enum class LampRule {
  kUniform,      // midpoints of equal steps
  kEquiAngular,  // midpoints of equal angles seen from the lamp: Kulla and Fajardo (2012),
                 // Computer Graphics Forum 31, 1519, stratified
  kHalfAngle,    // Gauss-Legendre in tan(theta / 2)
  kAsinh,        // Gauss-Legendre in asinh((t - t_c) / D)
};

/// Integrates a test case with a rule over its whole segment, which must be finite.
[[nodiscard]] double AirlightByRule(LampRule rule, const LampTestCase& work, int nodes);

}  // namespace alpenglow::renderer
