// SPDX-License-Identifier: MIT
#include "atmosphere/refraction/refraction.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/refraction/observer_refraction.h"

namespace alpenglow::atmosphere {
namespace {

/// Returns n r minus its value at the ground [m].
double OverGround(const BendingAir& air, double height_m) {
  double less = 0.0;
  for (const RefractivityLayer& layer : air.layers)
    less += layer.share * std::expm1(-height_m / layer.scale_height_m);
  return height_m * (1.0 + RefractivityAt(air, height_m)) +
         air.planet_radius_m * air.refractivity * less;
}

struct ValueAndSlope {
  double value, per_m;
};

/// Computes both together because they have the same exponentials. Layers with share 0 are skipped:
/// few media have all.
ValueAndSlope RefractivityAndSlopeAt(const BendingAir& air, double height_m) {
  double sum = 0.0, slope_sum = 0.0;
  for (const auto& [share, scale_height_m] : air.layers) {
    if (share == 0.0) continue;
    const double fall = std::exp(-height_m / scale_height_m);
    sum += share * fall;
    slope_sum += share / scale_height_m * fall;
  }
  return {air.refractivity * sum, -air.refractivity * slope_sum};
}

}  // namespace

double RefractivityAtSeaLevel(double wavelength_nm) {
  const double wave_number = 1000.0 / wavelength_nm;  // 1/um
  const double square = wave_number * wave_number;
  return 1e-8 * (5792105.0 / (238.0185 - square) + 167917.0 / (57.362 - square));
}

double RefractivityAt(const BendingAir& air, double height_m) {
  return RefractivityAndSlopeAt(air, height_m).value;
}

double RefractivitySlopeAt(const BendingAir& air, double height_m) {
  return RefractivityAndSlopeAt(air, height_m).per_m;
}

double CurvaturePerMetreAt(const BendingAir& air, double height_m) {
  const ValueAndSlope refractivity = RefractivityAndSlopeAt(air, height_m);
  return refractivity.per_m / (1.0 + refractivity.value);
}

bool GentlyBends(const BendingAir& air) {
  // Heights at which layers may be steep are sampled; between the ground and the top r increases by
  // less than a third.
  constexpr int kPlaces = 64;
  double steepest_per_m = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double height_m = 4.0 * air.UpperScaleHeight() * i / kPlaces;
    steepest_per_m = std::max(steepest_per_m, -RefractivitySlopeAt(air, height_m));
  }
  return steepest_per_m * air.planet_radius_m < 0.8;
}

RefractedRay::RefractedRay(const BendingAir& air, double elevation_rad, double height_m)
    : air_(air),
      elevation_rad_(elevation_rad),
      height_m_(std::max(height_m, 0.0)),
      invariant_m_((1.0 + RefractivityAt(air, height_m_)) * (air.planet_radius_m + height_m_) *
                   std::cos(elevation_rad)) {}

double RefractedRay::OverInvariant(double height_m) const {
  const double here_m =
      (1.0 + RefractivityAt(air_, height_m_)) * (air_.planet_radius_m + height_m_);
  const double half_sine = std::sin(0.5 * elevation_rad_);
  return OverGround(air_, height_m) - OverGround(air_, height_m_) +
         2.0 * here_m * half_sine * half_sine;
}

// Uses Newton's method, which converges because n r increases by at least a fifth of r.
double RefractedRay::HeightWhere(double elevation_rad) const {
  const double q = invariant_m_ / std::cos(elevation_rad);
  const double over_radius_m = q - air_.planet_radius_m;
  double height_m = over_radius_m;
  for (int step = 0; step < 20; ++step) {
    const auto [refractivity, per_m] = RefractivityAndSlopeAt(air_, height_m);
    const double radius_m = air_.planet_radius_m + height_m;
    const double excess_m = (height_m - over_radius_m) + refractivity * radius_m;
    const double correction_m = excess_m / (1.0 + refractivity + per_m * radius_m);
    height_m -= correction_m;
    if (std::abs(correction_m) < 1e-6) break;
  }
  return height_m;
}

double RefractedRay::ElevationAt(double height_m) const {
  const double q = (1.0 + RefractivityAt(air_, height_m)) * (air_.planet_radius_m + height_m);
  return 2.0 * std::asin(std::sqrt(std::clamp(0.5 * OverInvariant(height_m) / q, 0.0, 1.0)));
}

double RefractedRay::Bending(double low_rad, double high_rad) const {
  if (!(low_rad < high_rad)) return 0.0;
  const GaussRule& rule = GaussLegendre(32);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double height_m = HeightWhere(low_rad + (high_rad - low_rad) * rule.node[i]);
    const auto [refractivity, per_m] = RefractivityAndSlopeAt(air_, height_m);
    const double slope = per_m * (air_.planet_radius_m + height_m);  // r n'
    sum += rule.weight[i] * -slope / (1.0 + refractivity + slope);
  }
  return sum * (high_rad - low_rad);
}

double RefractedRay::MetresPerRadian(double elevation_rad, double height_m) const {
  const auto [refractivity, per_m] = RefractivityAndSlopeAt(air_, height_m);
  const double growth = 1.0 + refractivity + per_m * (air_.planet_radius_m + height_m);
  const double cosine = std::cos(elevation_rad);
  return invariant_m_ / (cosine * cosine * growth);
}

double GrazingElevation(const BendingAir& air, double height_m) {
  const double height = std::max(height_m, 0.0);
  const double here_m = (1.0 + RefractivityAt(air, height)) * (air.planet_radius_m + height);
  // This is acos(value at the ground / value here), without cancellation near 1.
  return -2.0 * std::asin(std::sqrt(0.5 * std::max(OverGround(air, height), 0.0) / here_m));
}

double RefractionSeenAt(const BendingAir& air, double apparent_elevation_rad, double height_m) {
  return RefractionOfObserver(air, height_m).SeenAt(apparent_elevation_rad);
}

BendingAir AlmanacAir(double earth_radius_m) {
  constexpr double kTop_m = 120e3;  // bending above it is 1e-8 of the whole
  return {.refractivity = RefractivityAtSeaLevel(kHorizonWavelength_nm),
          .layers = kAlmanacLayers,
          .top_m = kTop_m,
          .planet_radius_m = earth_radius_m};
}

double RefractionOfRay(double apparent_elevation_rad, double height_m, double earth_radius_m) {
  return RefractionSeenAt(AlmanacAir(earth_radius_m), apparent_elevation_rad, height_m);
}

SeaHorizon SeaHorizonFrom(double height_m, double earth_radius_m) {
  const double grazing = GrazingElevation(AlmanacAir(earth_radius_m), height_m);
  return {-grazing, grazing - RefractionOfRay(grazing, height_m, earth_radius_m)};
}

double RefractionFromHeight(const BendingAir& air, double true_elevation_rad, double height_m) {
  return RefractionOfObserver(air, height_m).AtTrue(true_elevation_rad);
}

double LiftForAir(const BendingAir& air, double true_elevation_rad) {
  constexpr double kShare = 0.2;
  const ObserverRefraction& at_sea_level = RefractionOfObserver(air, 0.0);
  if (true_elevation_rad >= 0.0) return kShare * at_sea_level.AtTrue(true_elevation_rad);
  const double on_horizon = at_sea_level.SeenAt(0.0);
  return kShare *
         (true_elevation_rad > -on_horizon ? at_sea_level.AtTrue(true_elevation_rad) : on_horizon);
}

}  // namespace alpenglow::atmosphere
