// SPDX-License-Identifier: MIT
// This header generates random test cases of lamps beside rays with reference results, and provides
// rules of the literature that integrate the same light, and the closed form of Sun, Ramamoorthi,
// Narasimhan and Nayar (2005), "A practical analytic single scattering model for real time
// rendering", ACM TOG 24, 1040, for isotropic scattering in homogeneous air.
#pragma once

#include <limits>

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

/// Returns F(u, v) of Sun et al. (2005), equation 11: the integral of exp(-u tan xi) over xi from 0
/// to v. Error below 1e-11.
/// @param u >= 0, v in [0, pi/2].
[[nodiscard]] double SunFunction(double u, double v);

/// Returns airlight by Sun et al. (2005), equation 10: an isotropic lamp in homogeneous air that
/// scatters isotropically, per unit intensity. It is computed as published, as the difference of
/// two values of F: its relative error is unbounded when the lamp approaches the line of the ray
/// outside of the segment.
/// @param along_m, across_m  position of the lamp along the ray, and its distance from the ray
/// (> 0).
/// @param length_m  length of the segment; may be infinite.
[[nodiscard]] double AirlightOfSun2005(double scattering_per_m, double extinction_per_m,
                                       double length_m, double along_m, double across_m);

}  // namespace alpenglow::renderer
