// SPDX-License-Identifier: MIT
#include "atmosphere/ray/bent_beam.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/ray/bent_view.h"

namespace alpenglow::atmosphere {
namespace {

constexpr int kHeights = 18, kElevations = 40;
constexpr double kTop_m = 40e3;  // the beam from over it has hardly met any air
/// Light about the horizon changes over this angle: 10 km of air at 1900 km look as high.
constexpr double kScale = 0.3 * kRadiansPerDegree;
/// The last node lies beside the zenith, where the cosine of the elevation is 0.
constexpr double kHighest_rad = 89.9 * kRadiansPerDegree;

double PlaceOf(double mu, double horizon_mu) {
  const double over = std::max(mu - horizon_mu, 0.0);
  return std::log1p(over / kScale) / std::log1p((1.0 - horizon_mu) / kScale);
}

double MuOf(double place, double horizon_mu) {
  return horizon_mu + kScale * std::expm1(place * std::log1p((1.0 - horizon_mu) / kScale));
}

/// Returns the nodes between which a place in [0, 1] lies: the lower one, and the share of the upper.
std::pair<std::size_t, double> BetweenNodes(double place, int nodes) {
  const double at = place * (nodes - 1);
  const int below = std::clamp(static_cast<int>(at), 0, nodes - 2);
  return {static_cast<std::size_t>(below), std::clamp(at - below, 0.0, 1.0)};
}

/// Returns the logarithm of the solid angle of a small disk that is seen at an elevation, over that which it has truly.
double LogSpread(const BendingAir& air, double elevation_rad, double height_m) {
  constexpr double kStep_rad = 1e-5;
  const double refraction = RefractionSeenAt(air, elevation_rad, height_m);
  const double slope =
      (RefractionSeenAt(air, elevation_rad + kStep_rad, height_m) - refraction) / kStep_rad;
  return std::log(std::cos(elevation_rad) / std::cos(elevation_rad - refraction) / (1.0 - slope));
}

}  // namespace

BentBeam::BentBeam(const Medium& medium)
    : bands_(medium.wavelengths_nm.size()),
      top_m_(std::min(medium.atmosphere_height_m, kTop_m)),
      molecules_per_m_(medium.rayleigh_scattering_per_m),
      aerosol_per_m_(medium.mie_extinction_per_m) {
  const BendingAir air = GentleAirOf(medium);
  if (air.refractivity == 0.0) return;
  const AirIntegrator<double> straight(medium);
  rows_.resize(kHeights);
  oneapi::tbb::parallel_for(0, kHeights, [&](int i) {
    const double share = static_cast<double>(i) / (kHeights - 1);
    rows_[static_cast<std::size_t>(i)] = RowAt(straight, air, share * share * top_m_);
  });
}

BentBeam::Row BentBeam::RowAt(const AirIntegrator<double>& straight, const BendingAir& air,
                              double height_m) {
  const Medium& medium = straight.medium();
  const auto densities = [&](double h_m) {
    return glm::dvec2(MoleculeDensity(medium, h_m), std::exp(-h_m / medium.mie_scale_height_m));
  };
  Row row{std::sin(GrazingElevation(air, height_m)), {}};
  for (int i = 0; i < kElevations; ++i) {
    const double mu = MuOf(static_cast<double>(i) / (kElevations - 1), row.horizon_mu);
    const double elevation = std::min(std::asin(std::min(mu, 1.0)), kHighest_rad);
    const std::array<double, 3> less = straight.ColumnsToSpace(height_m, std::sin(elevation));
    row.nodes.push_back(
        {BentRay(air, elevation, height_m).ColumnToSpace(densities) - glm::dvec2(less[0], less[1]),
         LogSpread(air, elevation, height_m)});
  }
  return row;
}

BentBeam::Node BentBeam::At(double altitude_m, double mu) const {
  const auto mix = [](const auto& a, const auto& b, double share) { return a + share * (b - a); };
  const double height = std::clamp(altitude_m / top_m_, 0.0, 1.0);
  const auto [row, up] = BetweenNodes(std::sqrt(height), kHeights);
  const Row &low = rows_[row], &high = rows_[row + 1];
  const auto [node, right] =
      BetweenNodes(PlaceOf(mu, mix(low.horizon_mu, high.horizon_mu, up)), kElevations);
  const auto in = [&, node = node, right = right](const Row& of) {
    const Node &a = of.nodes[node], &b = of.nodes[node + 1];
    return Node{mix(a.more_m, b.more_m, right), mix(a.log_spread, b.log_spread, right)};
  };
  const Node below = in(low), above = in(high);
  return {mix(below.more_m, above.more_m, up), mix(below.log_spread, above.log_spread, up)};
}

Bands<float> BentBeam::OverStraight(double altitude_m, double mu) const {
  Bands<float> over(bands_);
  const Node node = rows_.empty() ? Node{glm::dvec2(0.0), 0.0} : At(altitude_m, mu);
  for (std::size_t band = 0; band < bands_; ++band) {
    const double more =
        molecules_per_m_[band] * node.more_m[0] + aerosol_per_m_[band] * node.more_m[1];
    over[band] = static_cast<float>(std::exp(node.log_spread - more));
  }
  return over;
}

Bands<float> BentBeam::Left(const AirIntegrator<float>& air, double altitude_m, double mu) const {
  Bands<float> left = air.TransmittanceToSpace(altitude_m, mu);
  const Bands<float> over = OverStraight(altitude_m, mu);
  for (std::size_t band = 0; band < bands_; ++band) left[band] *= over[band];
  return left;
}

}  // namespace alpenglow::atmosphere
