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
//
// For comparison, this header also provides the closed form of Sun, Ramamoorthi, Narasimhan and
// Nayar (2005), "A practical analytic single scattering model for real time rendering", ACM TOG 24,
// 1040, for isotropic scattering in homogeneous air.
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
/// For a lamp of radius 0 on the ray itself, D = 0 is replaced by 1e-12 m: the result is then of the
/// order of 1e12, because the radiance of a point light in air is unbounded. Errors:
/// tests/bench/lamp_error.cpp, and the bounds asserted in tests/atmosphere/lamp/airlight_test.cpp.
/// @param nodes  total of all Gauss rules, in [kFewestLampNodes, kMostLampNodes]; each lit segment
/// of the ray has at least two, so that a beam may need some more.
[[nodiscard]] Bands<double> Airlight(const LampAir& air, const Lamp& lamp,
                                     const LampSegment& segment, int nodes = 16);

/// Cost of Airlight: the number of points at which the ray is evaluated.
struct AirlightEffort {
  int scouted = 0;     // evaluations in one band and the significant layers, to locate the light
  int integrated = 0;  // evaluations in every band and layer: nodes
};
[[nodiscard]] AirlightEffort EffortOfAirlight(const LampAir& air, const Lamp& lamp,
                                              const LampSegment& segment, int nodes = 16);

/// Returns the irradiance of a surface by airlight of an isotropic lamp, for unit intensity [m^-2],
/// in homogeneous air that fills all space: the integral of Airlight over the hemisphere. Error
/// below 1e-2 against the reference solution integrated over the hemisphere, g up to 0.9.
/// @param distance_m   distance of the lamp, > 0.
/// @param cos_normal   cosine between the surface's normal and the direction to the lamp, [-1, 1].
[[nodiscard]] Bands<double> AirlightOnSurface(const LampAir& air, double distance_m,
                                              double cos_normal);

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

}  // namespace alpenglow::atmosphere
