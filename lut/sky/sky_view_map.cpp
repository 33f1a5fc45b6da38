// SPDX-License-Identifier: MIT
#include "lut/sky/sky_view_map.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::lut {
namespace {

// Returns v for w = v + v^2 - v^3 in [0, 1], where w is monotone: Newton's method inside a
// shrinking bracket.
double CoordinateOfEdgedAir(double w) {
  double low = 0.0, high = 1.0, v = w;
  for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
    const double excess = v + v * v * (1.0 - v) - w;
    (excess < 0.0 ? low : high) = v;
    const double slope = (1.0 - v) * (1.0 + 3.0 * v);
    const double next = v - excess / slope;
    v = slope > 0.0 && next > low && next < high ? next : 0.5 * (low + high);
  }
  return v;
}

// Returns columns that are dense around the azimuth where the sun is slightly below the horizontal
// for points of the horizon, which lie a dip away from the observer along the ground: there the
// light on the limb fades within a few degrees.
AzimuthCrowd CrowdAtTerminator(double dip, double mu_s) {
  constexpr double kDarkening = -0.045;  // sine of the sun's elevation where the change is steepest
  constexpr double kExtent_rad = 0.07;   // range of the sun's elevation in which the light fades
  const double sun_sine = std::sqrt(std::max(1.0 - mu_s * mu_s, 0.0));
  const double reach = std::sin(dip) * sun_sine;
  const double cosine = (kDarkening - std::cos(dip) * mu_s) / std::max(reach, 1e-9);
  if (std::abs(cosine) >= 1.0) return {};
  const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  const double width = kExtent_rad / std::max(reach * sine, kExtent_rad);
  return {4.0, std::acos(cosine), std::clamp(width, 0.15, 1.0)};
}

}  // namespace

SkyViewMap::SkyViewMap(const Medium& medium, double altitude_m, double mu_s) {
  const double h = std::max(altitude_m, 0.0);
  const double r = medium.planet_radius_m + h;
  const double dip = DipOfHorizon(h, r);
  horizon_ = 0.5 * kPi + dip;
  outside_ = h > medium.atmosphere_height_m;
  if (outside_) edge_ = 0.5 * kPi + DipOfHorizon(h - medium.atmosphere_height_m, r);

  const double layer = std::min(medium.mie_scale_height_m, medium.rayleigh_scale_height_m);
  // The perigee rises by r (cos(dip - e) - cos(dip)) above the horizon: this is solved for one
  // layer. For a higher observer the layers are thinner than a pixel.
  const double per_layer = std::sqrt(dip * dip + 2.0 * layer / r) - dip;
  sky_.a = outside_ ? 4.0 * per_layer : per_layer;
  sky_.b = std::asinh((horizon_ - edge_) / sky_.a);
  crowd_ = CrowdAtTerminator(dip, mu_s);
  half_turn_integral_ = AzimuthIntegral(kPi);
  constexpr double kSmallestDip = 1e-4;
  ground_.a = std::max(dip, kSmallestDip);
  ground_.b = std::acosh(1.0 + (kPi - horizon_) / ground_.a);
}

// At the air's upper edge paths through the air shorten as the square root of the angle: nodes
// there are quadratic in v, w = v + v^2 - v^3.
double SkyViewMap::SkyZenithAngle(double v) const {
  const double w = outside_ ? v + v * v * (1.0 - v) : v;
  return horizon_ - sky_.a * std::sinh(sky_.b * w);
}

double SkyViewMap::GroundZenithAngle(double v) const {
  return horizon_ + ground_.a * (std::cosh(ground_.b * v) - 1.0);
}

double SkyViewMap::SkyCoordinate(double zenith_angle_rad) const {
  const double w =
      std::clamp(std::asinh((horizon_ - zenith_angle_rad) / sky_.a) / sky_.b, 0.0, 1.0);
  return outside_ ? CoordinateOfEdgedAir(w) : w;
}

double SkyViewMap::GroundCoordinate(double zenith_angle_rad) const {
  const double x = std::max(zenith_angle_rad - horizon_, 0.0) / ground_.a;
  return std::log1p(x + std::sqrt(x * (2.0 + x))) / ground_.b;  // acosh(1 + x) for small x
}

double SkyViewMap::AzimuthIntegral(double azimuth_rad) const {
  if (crowd_.strength == 0.0) return azimuth_rad;
  const auto bell = [&](double centre) {
    return std::atan((azimuth_rad - centre) / crowd_.width) + std::atan(centre / crowd_.width);
  };
  return azimuth_rad +
         crowd_.strength * crowd_.width *
             (bell(crowd_.azimuth) + bell(-crowd_.azimuth) + bell(2.0 * kPi - crowd_.azimuth));
}

double SkyViewMap::AzimuthCoordinate(double azimuth_rad) const {
  return AzimuthIntegral(azimuth_rad) / half_turn_integral_;
}

// Solved by bisection: the integral is monotone, and there are few nodes.
double SkyViewMap::Azimuth(double x) const {
  const double wanted = x * half_turn_integral_;
  double low = 0.0, high = kPi;
  if (x <= 0.0) return low;
  if (x >= 1.0) return high;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (AzimuthIntegral(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace alpenglow::lut
