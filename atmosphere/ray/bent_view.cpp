// SPDX-License-Identifier: MIT
#include "atmosphere/ray/bent_view.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/number/root.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kHorizontal = 0.5 * kPi;
constexpr int kSkyNodes = 256, kGroundNodes = 128;
constexpr double kLittleMoreDepth_rad = 15.0 * kRadiansPerDegree;
/// Where what is tabulated changes slowly to the next node: sizes of the air near the horizon.
constexpr double kRayLayer_m = 10e3, kWidest_rad = 0.3 * kRadiansPerDegree;

/// Nodes at x = s (exp(u) - 1), u even from 0 to that of the last.
double NodePlace(int node, int nodes, double scale, double last) {
  return scale * std::expm1(node * std::log1p(last / scale) / (nodes - 1));
}

/// Between which nodes a place lies: the lower one, and the share of the upper.
std::pair<std::size_t, double> BetweenNodes(double place, int nodes, double scale, double last) {
  const double at =
      (nodes - 1) * std::log1p(std::max(place, 0.0) / scale) / std::log1p(last / scale);
  const int below = std::clamp(static_cast<int>(at), 0, nodes - 2);
  return {static_cast<std::size_t>(below), std::clamp(at - below, 0.0, 1.0)};
}

/// Of the molecules, in the band next to where the eye is most sensitive, relative to air at sea
/// level.
double RelativeDensity(const Medium& medium) {
  const auto off = [](double wavelength_nm) {
    return std::abs(wavelength_nm - kHorizonWavelength_nm);
  };
  std::size_t middle = 0;
  for (std::size_t band = 1; band < medium.wavelengths_nm.size(); ++band)
    if (off(medium.wavelengths_nm[band]) < off(medium.wavelengths_nm[middle])) middle = band;
  const double wavelength_nm = std::max(medium.wavelengths_nm[middle], 250.0);
  return medium.rayleigh_scattering_per_m[middle] / RayleighScatteringAtSeaLevel(wavelength_nm);
}

}  // namespace

BendingAir BendingAirOf(const Medium& medium, double wavelength_nm) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  const RefractivityLayers of_molecules{{{1.0 + deficit.share, medium.rayleigh_scale_height_m},
                                         {-deficit.share, deficit.scale_height_m},
                                         {0.0, medium.rayleigh_scale_height_m}}};
  return {.refractivity = RelativeDensity(medium) * RefractivityAtSeaLevel(wavelength_nm),
          .layers = medium.refraction == RefractionBy::kAlmanacs ? kAlmanacLayers : of_molecules,
          .top_m = medium.atmosphere_height_m,
          .planet_radius_m = medium.planet_radius_m};
}

BendingAir GentleAirOf(const Medium& medium) {
  BendingAir air = BendingAirOf(medium, kHorizonWavelength_nm);
  if (!GentlyBends(air)) air.refractivity = 0.0;
  return air;
}

BentLight BentLightOf(const Medium& medium, const BendingAir& air, double elevation_rad,
                      double height_m) {
  BentLight light;
  light.refraction_rad = RefractionSeenAt(air, elevation_rad, height_m);
  constexpr double kStep = 1e-2;
  BendingAir thicker = air;
  thicker.refractivity *= 1.0 + kStep;
  if (air.refractivity > 0.0) {
    light.per_refractivity_rad =
        (RefractionSeenAt(thicker, elevation_rad, height_m) - light.refraction_rad) /
        (kStep * air.refractivity);
  }
  if (elevation_rad > kLittleMoreDepth_rad) return light;
  const auto molecules = [&](double h_m) { return MoleculeDensity(medium, h_m); };
  const auto aerosol = [&](double h_m) { return std::exp(-h_m / medium.mie_scale_height_m); };
  BendingAir still = air;
  still.refractivity = 0.0;
  const BentRay bent(air, elevation_rad, height_m), straight(still, elevation_rad, height_m);
  light.molecules_m = bent.ColumnToSpace(molecules) - straight.ColumnToSpace(molecules);
  light.aerosol_m = bent.ColumnToSpace(aerosol) - straight.ColumnToSpace(aerosol);
  return light;
}

BentView::BentView(const Medium& medium, double height_m)
    : air_(GentleAirOf(medium)), height_m_(std::max(height_m, 0.0)) {
  const double of_molecules = air_.refractivity / RefractivityAtSeaLevel(kHorizonWavelength_nm);
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    more_refractivity_.push_back(
        of_molecules * RefractivityAtSeaLevel(medium.wavelengths_nm[band]) - air_.refractivity);
    molecules_per_m_.push_back(medium.rayleigh_scattering_per_m[band]);
    aerosol_per_m_.push_back(medium.mie_extinction_per_m[band]);
  }
  horizon_rad_ = GrazingElevation(air_, height_m_);
  const double away_m = std::sqrt(height_m_ * (2.0 * air_.planet_radius_m + height_m_));
  sky_scale_rad_ = std::min(kWidest_rad, kRayLayer_m / std::max(away_m, 1.0));
  ground_scale_rad_ = std::clamp(-horizon_rad_, 1e-5, kWidest_rad);
  for (int i = 0; i < kSkyNodes; ++i) {
    const double over = NodePlace(i, kSkyNodes, sky_scale_rad_, kHorizontal - horizon_rad_);
    sky_.push_back(BentLightOf(medium, air_, horizon_rad_ + over, height_m_));
  }
  const double at_ground_m = (1.0 + air_.refractivity) * air_.planet_radius_m;
  const double at_eye_m =
      (1.0 + RefractivityAt(air_, height_m_)) * (air_.planet_radius_m + height_m_);
  for (int i = 0; i < kGroundNodes; ++i) {
    const double at_ground = NodePlace(i, kGroundNodes, ground_scale_rad_, kHorizontal);
    // The eye's elevation from that at the ground, by their common invariant.
    const double elevation =
        -std::acos(std::min(std::cos(at_ground) * at_ground_m / at_eye_m, 1.0));
    const BentRay ray(air_, elevation, height_m_);
    bending_.push_back(ray.Bending(at_ground, std::min(-elevation, ray.ElevationAt(air_.top_m))));
  }
}

BentView::Node BentView::At(double elevation_rad) const {
  const auto [below, share] = BetweenNodes(elevation_rad - horizon_rad_, kSkyNodes, sky_scale_rad_,
                                           kHorizontal - horizon_rad_);
  const Node &a = sky_[below], &b = sky_[below + 1];
  const auto between = [&, share = share](double Node::*of) {
    return a.*of + share * (b.*of - a.*of);
  };
  return {between(&Node::refraction_rad), between(&Node::per_refractivity_rad),
          between(&Node::molecules_m), between(&Node::aerosol_m)};
}

double BentView::TrueElevation(double elevation_rad, std::size_t band) const {
  const Node node = At(elevation_rad);
  return elevation_rad - node.refraction_rad - more_refractivity_[band] * node.per_refractivity_rad;
}

double BentView::TrueElevation(double elevation_rad) const {
  return elevation_rad - At(elevation_rad).refraction_rad;
}

double BentView::ApparentElevationOf(double true_elevation_rad) const {
  const double on_horizon = At(horizon_rad_).refraction_rad;
  if (true_elevation_rad <= horizon_rad_ - on_horizon) return horizon_rad_;
  const auto error = [&](double elevation) {
    return TrueElevation(elevation) - true_elevation_rad;
  };
  return BracketedRoot(error, std::max(true_elevation_rad, horizon_rad_),
                       true_elevation_rad + on_horizon + 1e-9, 1e-10);
}

double BentView::LiftedElevationOf(double true_elevation_rad) const {
  const double below_rad = TrueElevation(horizon_rad_) - true_elevation_rad;
  return ApparentElevationOf(true_elevation_rad) - std::max(below_rad, 0.0);
}

double BentView::MoreOpticalDepth(double elevation_rad, std::size_t band) const {
  const Node node = At(elevation_rad);
  return molecules_per_m_[band] * node.molecules_m + aerosol_per_m_[band] * node.aerosol_m;
}

std::optional<BentGroundRay> BentView::ToGround(double elevation_rad) const {
  if (elevation_rad >= horizon_rad_) return std::nullopt;
  const double at_ground = BentRay(air_, elevation_rad, height_m_).ElevationAt(0.0);
  const auto [below, share] = BetweenNodes(at_ground, kGroundNodes, ground_scale_rad_, kHorizontal);
  const double bending = bending_[below] + share * (bending_[below + 1] - bending_[below]);
  return BentGroundRay{-elevation_rad - at_ground + bending, at_ground};
}

}  // namespace alpenglow::atmosphere
