// SPDX-License-Identifier: MIT
#include "lut/diffuse/diffuse_march.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/number/quadrature.h"
#include "atmosphere/ray/shell.h"
#include "lut/diffuse/spherical_harmonics.h"

namespace alpenglow::lut {
namespace {

// Whether aerosol scatters less than 3e-4 of what molecules do, in every band: it then needs no
// more moments than they.
bool OnlyMolecules(const AirConstants<float>& air, float rayleigh_density, float mie_density) {
  for (std::size_t band = 0; band < air.bands; ++band) {
    if (air.mie_scattering[band] * mie_density > 3e-4F * air.rayleigh[band] * rayleigh_density)
      return false;
  }
  return true;
}

}  // namespace

DiffuseMarches::DiffuseMarches(const AirIntegrator<float>& air, const DiffuseLightOptions& options,
                               const std::vector<double>& chi)
    : air_(&air),
      chi_(&chi),
      grid_(GridOf(air.medium(), options)),
      radius_km_(air.medium().planet_radius_m / 1000.0),
      azimuths_(static_cast<std::size_t>(options.azimuth_nodes)) {
  for (int i = 0; i < options.altitudes; ++i) {
    const double u = static_cast<double>(i) / (options.altitudes - 1);
    altitude_km_.push_back(air.medium().atmosphere_height_m / 1000.0 * u * u);
  }
  for (int j = 0; j < options.sun_angles; ++j) {
    mu_s_.push_back(MuSOfNode(grid_, static_cast<std::size_t>(j)));
    mu_s_floats_.push_back(static_cast<float>(mu_s_.back()));
    sine_s_.push_back(static_cast<float>(SineOf(mu_s_.back())));
  }
  for (std::size_t m = 0; m < azimuth_cosines_.size(); ++m) {
    azimuth_cosines_[m] = AlignedFloats(kMostAzimuths);
    for (std::size_t k = 0; k < azimuths_; ++k) {
      const double azimuth = (static_cast<double>(k) + 0.5) * kPi / options.azimuth_nodes;
      azimuth_cosines_[m].data()[k] =
          static_cast<float>(std::cos(static_cast<double>(m) * azimuth));
    }
  }
  for (std::size_t m = 1; m <= azimuth_sines_.size(); ++m) {
    azimuth_sines_[m - 1] = AlignedFloats(kMostAzimuths);
    for (std::size_t k = 0; k < azimuths_; ++k) {
      const double azimuth = (static_cast<double>(k) + 0.5) * kPi / options.azimuth_nodes;
      azimuth_sines_[m - 1].data()[k] =
          static_cast<float>(std::sin(static_cast<double>(m) * azimuth));
    }
  }
  marches_.resize(altitude_km_.size());
  tbb::parallel_for(std::size_t{0}, marches_.size(),
                    [&](std::size_t i) { marches_[i] = MarchesAt(i, options); });
}

MarchDirection DiffuseMarches::Direction(std::size_t altitude, const March& march) const {
  return {march.mu,
          march.sine,
          static_cast<float>(radius_km_ + altitude_km_[altitude]),
          mu_s_floats_.data(),
          sine_s_.data(),
          azimuth_cosines_[1].data(),
          azimuths_};
}

double DiffuseMarches::Nu(const March& march, std::size_t sun, std::size_t azimuth) const {
  const double mu = static_cast<double>(march.mu);
  const double nu = mu * mu_s_[sun] + SineOf(mu) * SineOf(mu_s_[sun]) *
                                          static_cast<double>(AzimuthCosine(1, azimuth));
  return std::clamp(nu, -1.0, 1.0);
}

// Gauss nodes above and below the horizon, dense near it: mu - horizon = range v^2.
std::vector<March> DiffuseMarches::MarchesAt(std::size_t altitude,
                                             const DiffuseLightOptions& options) const {
  const double horizon = shared::HorizonCosine<double>(altitude_km_[altitude], radius_km_);
  const GaussRule& rule = GaussLegendre(options.zenith_nodes);
  std::vector<March> marches;
  for (const double end : {-1.0, 1.0}) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double v = rule.node[k];
      March march;
      march.mu = static_cast<float>(horizon + (end - horizon) * v * v);
      march.sine = static_cast<float>(SineOf(static_cast<double>(march.mu)));
      march.solid_angle = static_cast<float>(std::abs(end - horizon) * 4.0 * v * rule.weight[k] *
                                             kPi / options.azimuth_nodes);
      const Moments legendre = LegendreTerms(options.degree, march.mu);
      std::copy(legendre.begin(), legendre.end(), march.legendre.begin());
      AddPoints(altitude, options, static_cast<double>(march.mu), march);
      marches.push_back(std::move(march));
    }
  }
  return marches;
}

void DiffuseMarches::AddPoints(std::size_t altitude, const DiffuseLightOptions& options, double mu,
                               March& march) const {
  // With the sun in the zenith no part of the ray is in shadow: one set of panels serves every sun.
  const ViewRay ray{altitude_km_[altitude] * 1000.0, mu, 1.0, mu};
  const RaySamples<float> samples =
      air_->Sample(ray, {.nodes = options.ray_nodes, .split_ozone = false, .dark_samples = true});
  for (std::size_t s = 0; s < samples.count; ++s) {
    const float h = samples.altitude[s];
    const CubicTaps taps =
        TapsAt(std::sqrt(static_cast<double>(h / grid_.top_km)), options.altitudes);
    MarchPoint point{};
    for (std::size_t tap = 0; tap < 4; ++tap) {
      point.altitude_node[tap] = static_cast<std::uint32_t>(taps.node[tap]);
      point.altitude_weight[tap] = taps.weight[tap];
    }
    point.mu = samples.mu[s];
    point.sine = static_cast<float>(SineOf(static_cast<double>(point.mu)));
    point.distance_km = samples.distance[s];
    point.inverse_radius = static_cast<float>(1.0 / (radius_km_ + static_cast<double>(h)));
    point.only_molecules =
        OnlyMolecules(air_->constants(), samples.rayleigh_density[s], samples.mie_density[s]);
    const Moments legendre = LegendreTerms(options.degree, point.mu);
    std::copy(legendre.begin(), legendre.end(), point.legendre.begin());
    march.points.push_back(point);
    march.air.push_back({samples.weight[s], samples.rayleigh_density[s], samples.mie_density[s],
                         samples.view_rayleigh[s], samples.view_mie[s], samples.view_ozone[s]});
  }
  const double end = samples.extent.end_m / 1000.0;
  const double lowest = -(radius_km_ + altitude_km_[altitude]) * mu;
  march.panels = {0.0, end};
  if (lowest > 0.0 && lowest < end) march.panels = {0.0, lowest, end};
  march.hits_ground = samples.extent.end == RayEnd::kGround;
  march.ground_distance_km = end;
  if (march.hits_ground) AddGround(altitude, march);
}

void DiffuseMarches::AddGround(std::size_t altitude, March& march) const {
  const double mu = static_cast<double>(march.mu);
  const double r = radius_km_ + altitude_km_[altitude];
  march.ground_transmittance =
      air_->TransmittanceAlong({altitude_km_[altitude] * 1000.0, mu, 1.0, mu});
  for (std::size_t j = 0; j < mu_s_.size(); ++j) {
    for (std::size_t k = 0; k < azimuths_; ++k) {
      const double mu_s = std::clamp(
          (r * mu_s_[j] + march.ground_distance_km * Nu(march, j, k)) / radius_km_, -1.0, 1.0);
      CubicTaps taps = TapsAt(DiffuseLight::SunCoordinate(mu_s), static_cast<int>(grid_.suns));
      const float twilight = TwilightOf(grid_, mu_s);
      for (float& weight : taps.weight) weight *= twilight;
      march.ground_taps.push_back(taps);
    }
  }
}

}  // namespace alpenglow::lut
