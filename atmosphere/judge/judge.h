// SPDX-License-Identifier: MIT
// The judges: slow, plainly right answers that every fast method is held against.
//
// Optical depth and single scattering along any ray, by adaptive Gauss-Legendre
// quadrature in the distance. Positions are taken in extended precision from the plain
// formula sqrt(r^2 + 2 r mu t + t^2) - R; nothing here uses the shared texts, the closed
// forms or the tables.
#pragma once

#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray.h"

namespace alpenglow::atmosphere::judge {

/// Optical depth at every wavelength, from the observer to the end of the
/// ray (ray.length_m, ground or top). Relative error below 1e-10
/// (asserted against stored cases to 1e-8 and against closed forms).
struct OpticalDepth {
  std::vector<double> tau;
  bool blocked = false;  // the ray meets the ground
  bool converged = true;
};
[[nodiscard]] OpticalDepth OpticalDepthAlong(const Medium& medium, const ViewRay& ray);

/// Single scattering for unit solar irradiance [1/sr], at every wavelength.
struct SingleScattering {
  std::vector<double> inscatter;      // light scattered once by the air, towards the observer
  std::vector<double> ground;         // sunlight reflected by the ground at the end of the ray
  std::vector<double> transmittance;  // of the ray
  double error = 0.0;                 // estimate, relative
  bool converged = true;
};

/// Relative error below 1e-8 by its own estimate; stored cases agree to 1e-7. The sun is a point,
/// the planet's shadow is sharp and split exactly, the ground is lit where mu_s >= 0 at its point.
/// Ground light is 0 where BringsLightOfGround says so.
[[nodiscard]] SingleScattering SingleScatteringAlong(const Medium& medium, const ViewRay& ray);

/// Direct solar irradiance on a horizontal plane at an altitude, per unit irradiance: mu_s T(mu_s),
/// 0 with the sun below the horizon of the plane or behind the planet.
[[nodiscard]] std::vector<double> SunIrradiance(const Medium& medium, double altitude_m,
                                                double mu_s);

}  // namespace alpenglow::atmosphere::judge
