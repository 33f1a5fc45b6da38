// SPDX-License-Identifier: MIT
// The judge of bent rays: the ray equation, d/ds (n dr/ds) = grad n, integrated step by step in the
// plane of the ray (Runge and Kutta's fourth order). It shares neither Bouguer's law nor the angles
// with what it judges.
#pragma once

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere::judge {

/// n - 1 of air of 15 C and 1013.25 hPa. Peck and Reeder (1972), J. Opt. Soc. Am. 62, 958-962,
/// equation 2.
[[nodiscard]] double PeckAndReeder(double wavelength_nm);

/// Rays in a medium, whose refractivity falls off as it says; refers to the medium.
class RayEquation {
 public:
  /// @param refractivity  n - 1 at altitude 0; 0 for straight rays.
  RayEquation(const Medium& medium, double refractivity)
      : medium_(medium), refractivity_(refractivity) {}

  /// In a plane through the planet's centre: x along the horizontal of the eye, y up.
  struct State {
    double x, y, p, q;  // place [m], and n times the direction
  };
  struct End {
    double refraction_rad = 0.0;  // apparent elevation less that of the ray's end
    double column_m = 0.0;        // of molecules
    bool is_ground = false;
    double angle_rad = 0.0;  // at the centre
    State state{};
  };

  /// Follows the line of sight of an apparent elevation to the ground, out of the air or up to a
  /// length (at least to where it enters the air). Shorter steps make no difference of 0.001'.
  [[nodiscard]] End Follow(double elevation_rad, double height_m, double length_m = 1e12) const;

 private:
  [[nodiscard]] double Density(double height_m) const;
  /// Refractivity relative to altitude 0.
  [[nodiscard]] double Refracting(double height_m) const;
  [[nodiscard]] double Height(const State& at) const;
  double EnterAir(State& at) const;
  [[nodiscard]] State Slope(const State& at) const;
  [[nodiscard]] State Stepped(const State& at, double step_m) const;

  const Medium& medium_;
  double refractivity_;
};

}  // namespace alpenglow::atmosphere::judge
