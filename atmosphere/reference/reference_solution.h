// SPDX-License-Identifier: MIT
// Reference solutions: slow and simple computations, against which every fast method is tested.
//
// Optical depth and single scattering along any ray are computed by adaptive Gauss-Legendre
// quadrature in the distance. Positions are computed in extended precision from the formula
// sqrt(r^2 + 2 r mu t + t^2) - R. Of the shared sources, closed forms and tables, these functions
// use only the values of phase functions.
//
// The reference for refracted rays is the ray equation, d/ds (n dr/ds) = grad n, integrated step by
// step in the plane of the ray (fourth-order Runge-Kutta method). It uses neither Bouguer's law nor
// the angles of the method under test.
#pragma once

#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"

namespace alpenglow::atmosphere::reference {

/// Optical depth at every wavelength, from the observer to the end of the ray (ray.length_m, ground
/// or top). Relative error below 1e-10 (asserted against stored cases to 1e-8 and against closed
/// forms).
struct OpticalDepth {
  std::vector<double> tau;
  bool blocked = false;  // the ray hits the ground
  bool converged = true;
};
[[nodiscard]] OpticalDepth OpticalDepthAlong(const Medium& medium, const ViewRay& ray);

/// Single scattering for unit solar irradiance [1/sr], at every wavelength.
struct RayRadiance {
  std::vector<double> inscatter;      // light scattered once by the air, towards the observer
  std::vector<double> ground;         // sunlight reflected by the ground at the end of the ray
  std::vector<double> transmittance;  // of the ray
  double error = 0.0;                 // estimate, relative
  bool converged = true;
};

/// Returns single scattering along a ray. The relative error is below 1e-8 by its own estimate;
/// stored cases agree to 1e-7. The sun is a point. The planet's shadow is sharp, and its edges are
/// breakpoints of the quadrature. The ground is lit where mu_s >= 0 at its point. Reflected light
/// is 0 if BringsLightOfGround returns false.
[[nodiscard]] RayRadiance SingleScatteringAlong(const Medium& medium, const ViewRay& ray);

/// Returns the direct solar irradiance on a horizontal plane at an altitude, per unit irradiance:
/// mu_s T(mu_s), 0 if the sun is below the horizon of the plane or behind the planet.
[[nodiscard]] std::vector<double> SunIrradiance(const Medium& medium, double altitude_m,
                                                double mu_s);

/// Returns n - 1 for air of 15 C and 1013.25 hPa. Peck and Reeder (1972), J. Opt. Soc. Am. 62,
/// 958-962, equation 2.
[[nodiscard]] double PeckAndReeder(double wavelength_nm);

/// Traces refracted rays in a medium, with the medium's profile of refractivity; holds a reference
/// to the medium.
class RayEquation {
 public:
  /// @param refractivity  n - 1 at altitude 0; 0 for straight rays.
  RayEquation(const Medium& medium, double refractivity)
      : medium_(medium), refractivity_(refractivity) {}

  /// State in a plane through the planet's centre: x along the horizontal of the observer, y up.
  struct State {
    double x, y, p, q;  // position [m], and n times the direction
  };
  struct End {
    double refraction_rad = 0.0;  // apparent elevation minus the elevation of the ray at its end
    double column_m = 0.0;        // column of molecules
    bool is_ground = false;
    double angle_rad = 0.0;  // at the planet's centre
    State state{};
  };

  /// Follows the line of sight of an apparent elevation until it hits the ground, leaves the air or
  /// reaches a length (at least until it enters the air). Shorter steps change the result by less
  /// than 0.001'.
  [[nodiscard]] End Follow(double elevation_rad, double height_m, double length_m = 1e12) const;

 private:
  [[nodiscard]] double Density(double height_m) const;
  /// Returns the refractivity relative to altitude 0.
  [[nodiscard]] double Refracting(double height_m) const;
  [[nodiscard]] double Height(const State& at) const;
  double EnterAir(State& at) const;
  [[nodiscard]] State Slope(const State& at) const;
  [[nodiscard]] State Stepped(const State& at, double step_m) const;

  const Medium& medium_;
  double refractivity_;
};

}  // namespace alpenglow::atmosphere::reference
