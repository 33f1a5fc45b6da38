// SPDX-License-Identifier: MIT
// Airlight: what the air between a lamp and an eye scatters, once, into the eye.
//
//   L = integral over the ray of  sigma_s(t) p(cos) I(direction) / d^2  T(eye to t) T(t to lamp) dt
//
// With t_c the point of the ray nearest to the lamp, D its distance and t = t_c + D sinh x,
//
//   dt / d^2 = sech(x) dx / D,    cos of the scattering angle = -tanh x,
//
// and everything that a lamp, a phase function, extinction and an exponential density do is smooth
// in x on a scale of 1 or, where density or extinction falls fast, on one that can be seen from
// outside. (D x = the asinh rule; tan(theta / 2) = tanh(x / 2) of Kulla and Fajardo's equi-angular
// theta, 2012, CGF 31, 1519, is the map below with mode 0 and scale 1.) The integrand is scouted at
// a few points, cut at the edges of the lamp's beam and between its maxima, and each maximum at
// mode m of scale s is integrated by Gauss-Legendre in
//
//   v = tanh((x - m) / 2 s),
//
// which turns tails falling as exp(-|x - m| / s) into finite, smooth ends.
//
// Beside it, for comparison, the closed form of Sun, Ramamoorthi, Narasimhan and Nayar (2005), "A
// practical analytic single scattering model for real time rendering", ACM TOG 24, 1040, for
// isotropic scattering in homogeneous air.
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#include "atmosphere/lamp/lamp.h"

namespace alpenglow::atmosphere {

/// A piece of a view ray. Transmittance counts from the origin, not from begin_m.
struct LampSegment {
  glm::dvec3 origin_m{0.0};
  glm::dvec3 direction{1.0, 0.0, 0.0};  // unit
  double begin_m = 0.0;
  double end_m = std::numeric_limits<double>::infinity();  // infinite in homogeneous air only
};

inline constexpr int kFewestLampNodes = 2;
inline constexpr int kMostLampNodes = 64;

/// Radiance in-scattered along the segment towards its
/// origin, for unit intensity [sr^-1 m^-2], in every band.
///
/// @param nodes  of all Gauss rules together, in [kFewestLampNodes, kMostLampNodes]; each lit piece
///               of the ray has at least two, so that a beam may need some more.
/// A lamp of radius 0 on the ray itself (D = 0) has D = 1e-12 m: the ray is then 1e12 bright, which
/// is what a point of light in air is. Errors: tests/bench/lamp_error.cpp, and its asserted bounds
/// in tests/atmosphere/airlight_test.cpp.
[[nodiscard]] Bands<double> Airlight(const LampAir& air, const Lamp& lamp,
                                     const LampSegment& segment, int nodes = 16);

/// What Airlight costs: at how many points it looks at the ray.
struct AirlightEffort {
  int scouted = 0;     // in one band, and in the layers that matter: to find where the light is
  int integrated = 0;  // in every band and layer: nodes
};
[[nodiscard]] AirlightEffort EffortOfAirlight(const LampAir& air, const Lamp& lamp,
                                              const LampSegment& segment, int nodes = 16);

/// Irradiance that the air's light of an isotropic lamp brings to a surface, for unit intensity
/// [m^-2], in homogeneous air that fills all space: the integral of Airlight over the hemisphere.
/// @param distance_m   of the lamp, > 0.
/// @param cos_normal   between the surface's normal and the direction to the lamp, [-1, 1].
/// Error below 1e-2 against quadrature over the hemisphere by the judge, g up to 0.9.
[[nodiscard]] Bands<double> AirlightOnSurface(const LampAir& air, double distance_m,
                                              double cos_normal);

/// F(u, v) of Sun et al. (2005), equation 11: the integral of exp(-u tan xi) over xi from 0 to v.
/// @param u >= 0, v in [0, pi/2]. Error below 1e-11.
[[nodiscard]] double SunFunction(double u, double v);

/// Sun et al. (2005), equation 10: airlight of an isotropic lamp in homogeneous air that scatters
/// isotropically, per unit intensity. As published, by the difference of two F: its relative error
/// grows without bound as the lamp nears the ray's line outside of the segment.
/// @param along_m, across_m  position of the lamp along the ray and off it (> 0).
/// @param length_m  of the segment; may be infinite.
[[nodiscard]] double AirlightOfSun2005(double scattering_per_m, double extinction_per_m,
                                       double length_m, double along_m, double across_m);

}  // namespace alpenglow::atmosphere
