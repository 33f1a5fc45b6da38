// SPDX-License-Identifier: MIT
// Airlight: single scattering of a lamp's light by the air, along a view ray.
//
//   L = integral over the ray of  sigma_s(t) p(cos) I(direction) / d^2  T(eye to t) T(t to lamp) dt
//
// With t_c the point of the ray nearest to the lamp, D its distance and t = t_c + D sinh x,
//
//   dt / d^2 = sech(x) dx / D,    cos of the scattering angle = -tanh x,
//
// and the factors of a lamp, a phase function, extinction and an exponential density are all smooth
// in x on a scale of 1 or, where density or extinction decreases fast, on a scale that can be
// estimated in advance. (D x = the asinh rule; tan(theta / 2) = tanh(x / 2) of Kulla and Fajardo's
// equi-angular theta, 2012, CGF 31, 1519, is the map below with mode 0 and scale 1.) The integrand
// is scouted at a few points, cut at the edges of the lamp's beam and between its maxima, and each
// maximum at mode m of scale s is integrated by Gauss-Legendre in
//
//   v = tanh((x - m) / 2 s),
//
// which maps tails falling as exp(-|x - m| / s) to finite, smooth ends.
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#include "atmosphere/lamp/lamp.h"

namespace alpenglow::atmosphere {

/// A segment of a view ray. Transmittance is counted from the origin, not from begin_m.
struct LampSegment {
  glm::dvec3 origin_m{0.0};
  glm::dvec3 direction{1.0, 0.0, 0.0};  // unit vector
  double begin_m = 0.0;
  double end_m = std::numeric_limits<double>::infinity();  // infinite in homogeneous air only
};

inline constexpr int kFewestLampNodes = 2;
inline constexpr int kMostLampNodes = 64;

/// Returns the radiance scattered along the segment towards its origin, for unit intensity
/// [sr^-1 m^-2], in every band.
///
/// For a lamp of radius 0 on the ray itself, D = 0 is replaced by 1e-12 m: the result is then of
/// the order of 1e12, because the radiance of a point light in air is unbounded. Errors:
/// `skyseries report`, and the bounds asserted in tests/atmosphere/lamp/airlight_test.cpp.
/// @param nodes  total of all Gauss rules, in [kFewestLampNodes, kMostLampNodes]; each lit segment
/// of the ray has at least two, so that a beam may need some more.
[[nodiscard]] SpectrumOf<double> Airlight(const LampAir& air, const Lamp& lamp,
                                          const LampSegment& segment, int nodes = 16);

/// Cost of Airlight: the number of points at which the ray is evaluated.
struct AirlightEffort {
  int scouted = 0;     // evaluations in one band and the significant layers, to locate the light
  int integrated = 0;  // evaluations in every band and layer: nodes
};
[[nodiscard]] AirlightEffort EffortOfAirlight(const LampAir& air, const Lamp& lamp,
                                              const LampSegment& segment, int nodes = 16);

}  // namespace alpenglow::atmosphere
