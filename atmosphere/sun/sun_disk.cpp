// SPDX-License-Identifier: MIT
#include "atmosphere/sun/sun_disk.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/disk_light.h"

namespace alpenglow::atmosphere {

VisibleDisk DiskOverHorizon(double mu_s, double horizon_mu, double radius_rad) {
  const double elevation = std::asin(std::clamp(mu_s, -1.0, 1.0));
  const double horizon = std::asin(std::clamp(horizon_mu, -1.0, 1.0));
  const double x = (elevation - horizon) / radius_rad;  // centre over horizon, in radii
  if (x >= 1.0) return {1.0, mu_s};
  if (x <= -1.0) return {0.0, mu_s};
  // Segment of the unit disk on the side of the centre's
  // height over the chord at distance x below it.
  const double chord = std::sqrt(1.0 - x * x);
  const double area = kPi - std::acos(x) + x * chord;
  const double centroid = 2.0 / 3.0 * chord * chord * chord / area;  // above the disk's centre
  return {area / kPi, std::sin(elevation + centroid * radius_rad)};
}

double DiskSolidAngle(double radius_rad) {
  const double half_sine = std::sin(0.5 * radius_rad);
  return 4.0 * kPi * half_sine * half_sine;
}

double LimbDarkening(double rho) { return shared::SunLimbDarkening(rho); }

double LimbDarkening(double rho, double wavelength_nm) {
  return shared::SunLimbDarkeningAt(rho, wavelength_nm / 1000.0);
}

// With u = 0.6 the light outside of the circle is mu^2 (1 + mu) / 2 of all: a cubic, by Newton from
// above, where it is convex. Where mu is small it halves with each step, but then the root is lost
// in 1 - mu^2.
double CircleOfLight(double share) {
  const double twice = 2.0 * std::clamp(1.0 - share, 0.0, 1.0);
  double mu = 1.0;
  for (int i = 0; i < 12; ++i) {
    const double above = mu * mu * (1.0 + mu) - twice;
    if (above <= 1e-12) break;
    mu -= above / (mu * (2.0 + 3.0 * mu));
  }
  return std::sqrt(std::max(1.0 - mu * mu, 0.0));
}

}  // namespace alpenglow::atmosphere
