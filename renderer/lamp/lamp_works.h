// SPDX-License-Identifier: MIT
// Lamps beside rays, drawn at random, with the judge's answers; and rules of the literature that
// integrate the same light.
#pragma once

#include "atmosphere/lamp/airlight.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// What is the same for a set of works.
struct LampWorkKind {
  double g = 0.8;                                                   // Henyey-Greenstein
  double scale_height_m = std::numeric_limits<double>::infinity();  // of the fog
  bool beam = false;                                                // a cone instead of all around
  bool through = false;    // the ray meets the lamp, a ball of 0.1 m
  bool clear_air = false;  // molecules and aerosol stand with the fog and over it
};

/// A lamp, a ray and the air around them.
struct LampWork {
  LampAir air;
  Lamp lamp;
  LampSegment segment;
  double truth = 0.0;     // by judge::AirlightAlong
  bool converged = true;  // the judge was
};

/// Number i >= 1: extinction 1e-4 to 0.1 per metre at the lowest point, distance of the lamp from
/// the ray 0.1 to 100 m, segments of 10 to 1000 m, the lamp beside, before or behind the segment.
[[nodiscard]] LampWork LampWorkNumber(int i, const LampWorkKind& kind);

/// How a ray is walked through the light of a lamp, one band.
enum class LampRule {
  kUniform,      // midpoints of equal steps
  kEquiAngular,  // midpoints of equal angles as the lamp sees them: Kulla and Fajardo (2012),
                 // Computer Graphics Forum 31, 1519, in strata
  kHalfAngle,    // Gauss-Legendre in tan(theta / 2)
  kAsinh,        // Gauss-Legendre in asinh((t - t_c) / D)
};

/// By a rule on the whole segment, which must end.
[[nodiscard]] double AirlightByRule(LampRule rule, const LampWork& work, int nodes);

}  // namespace alpenglow::renderer
