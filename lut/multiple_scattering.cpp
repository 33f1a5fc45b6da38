// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/constants.h"
#include "atmosphere/error.h"
#include "lut/cubic_taps.h"
#include "lut/successive_orders.h"

namespace alpenglow {

double DiffuseLight::SunCoordinate(double mu_s) {
  const double low = std::asinh((kLowestMuS - kSunCentre) / kSunWidth);
  const double high = std::asinh((1.0 - kSunCentre) / kSunWidth);
  return std::clamp((std::asinh((mu_s - kSunCentre) / kSunWidth) - low) / (high - low), 0.0, 1.0);
}

double DiffuseLight::MuSFromCoordinate(double v) {
  const double low = std::asinh((kLowestMuS - kSunCentre) / kSunWidth);
  const double high = std::asinh((1.0 - kSunCentre) / kSunWidth);
  return std::clamp(kSunCentre + kSunWidth * std::sinh(low + (high - low) * v), -1.0, 1.0);
}

namespace {

// What the solver and the look-ups take for granted.
const Medium& Checked(const Medium& medium, const DiffuseLightOptions& options) {
  RequireInRange(options.altitudes, 4, 1024, "altitudes");
  RequireInRange(options.sun_angles, 4, 1024, "sun_angles");
  RequireInRange(options.degree, 2, kMaxDegree, "degree");
  RequireInRange(options.exact_orders.value_or(1), 1, 1000, "exact_orders");
  Validate(medium);
  if (medium.wavelengths_nm.size() > kMaxBands) {
    throw InputError(
        fmt::format("spectrum.wavelengths_nm has {} values; diffuse light is kept for at most {}",
                    medium.wavelengths_nm.size(), kMaxBands));
  }
  return medium;
}

}  // namespace

DiffuseLight::DiffuseLight(const Medium& medium, const DiffuseLightOptions& options)
    : DiffuseLight(medium, options, SolveSuccessiveOrders(Checked(medium, options), options)) {}

DiffuseLight::DiffuseLight(const Medium& medium, const DiffuseLightOptions& options,
                           SolvedOrders solved)
    : medium_(Checked(medium, options)),
      options_(options),
      bands_(medium.wavelengths_nm.size()),
      orders_(solved.orders),
      converged_(solved.converged),
      values_(std::move(solved.values)) {
  moments_ = MomentCount(options.degree);
  for (const double chi : MieLegendreCoefficients(medium, options.degree)) {
    chi_mie_.push_back(static_cast<float>(chi));
  }
  for (std::size_t band = 0; band < bands_; ++band) {
    const auto per_km = [band](const std::vector<double>& per_m) {
      return static_cast<float>(per_m[band] * 1000.0);
    };
    coefficients_.push_back(
        {per_km(medium.rayleigh_scattering_per_m), per_km(medium.mie_extinction_per_m),
         per_km(medium.ozone_absorption_per_m), per_km(medium.mie_scattering_per_m)});
  }
  const std::size_t expected = static_cast<std::size_t>(options.altitudes) *
                               static_cast<std::size_t>(options.sun_angles) * channels() * bands_;
  if (values_.size() != expected) {
    throw InputError(
        fmt::format("diffuse light: {} values; its options need {}", values_.size(), expected));
  }
  for (const float value : values_) {
    if (!std::isfinite(value)) throw InputError("diffuse light: a value is not finite");
  }
}

namespace {

// Channels of the table at a point, interpolated with cubic taps: [channel * bands + band].
template <typename Visit>
void VisitTaps(const DiffuseLightOptions& options, double u, double v, const Visit& visit) {
  const CubicTaps row = TapsAt(u, options.altitudes);
  const CubicTaps column = TapsAt(v, options.sun_angles);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t s = 0; s < 4; ++s) {
      const float weight = row.weight[a] * column.weight[s];
      if (weight != 0.0F)
        visit(row.node[a] * static_cast<std::size_t>(options.sun_angles) + column.node[s], weight);
    }
  }
}

}  // namespace

void DiffuseLight::Interpolate(double altitude_m, double mu_s, std::span<float> moments) const {
  std::fill(moments.begin(), moments.end(), 0.0F);
  const double u = std::sqrt(std::clamp(altitude_m / medium_.atmosphere_height_m, 0.0, 1.0));
  const std::size_t stride = channels() * bands_;
  VisitTaps(options_, u, SunCoordinate(mu_s), [&](std::size_t node, float weight) {
    const float* values = &values_[node * stride];
    for (std::size_t k = 0; k < moments.size(); ++k) moments[k] += weight * values[k];
  });
}

Bands<float> DiffuseLight::InscatterAlong(const RaySamples<float>& samples, double nu) const {
  Bands<float> sum(bands_);
  std::array<float, kMaxMoments * kMaxBands> storage;
  const std::span<float> moments(storage.data(), moments_ * bands_);
  for (std::size_t s = 0; s < samples.count; ++s) {
    Interpolate(static_cast<double>(samples.altitude[s]) * 1000.0,
                static_cast<double>(samples.mu_s[s]), moments);
    const auto harmonics =
        SphericalHarmonics(options_.degree, samples.mu[s],
                           AzimuthCosine(samples.mu[s], samples.mu_s[s], static_cast<float>(nu)));
    std::array<float, kMaxBands> rayleigh{}, mie{};
    for (int l = 0; l <= options_.degree; ++l) {
      const float* mie_chi = &chi_mie_[static_cast<std::size_t>(l) * bands_];
      const float rayleigh_chi = l == 0 ? 1.0F : l == 2 ? 0.1F : 0.0F;
      for (int m = 0; m <= l; ++m) {
        const std::size_t i = MomentIndex(l, m);
        for (std::size_t band = 0; band < bands_; ++band) {
          const float light = harmonics[i] * moments[i * bands_ + band];
          mie[band] += mie_chi[band] * light;
          rayleigh[band] += rayleigh_chi * light;
        }
      }
    }
    for (std::size_t band = 0; band < bands_; ++band) {
      const std::array<float, 4>& k = coefficients_[band];
      const float tau = k[0] * samples.view_rayleigh[s] + k[1] * samples.view_mie[s] +
                        k[2] * samples.view_ozone[s];
      const float source = k[0] * samples.rayleigh_density[s] * std::max(rayleigh[band], 0.0F) +
                           k[3] * samples.mie_density[s] * std::max(mie[band], 0.0F);
      sum[band] += samples.weight[s] * std::exp(-tau) * source;
    }
  }
  return sum;
}

Bands<float> DiffuseLight::Irradiance(double altitude_m, double mu_s, double normal_mu,
                                      double normal_cos_azimuth) const {
  // pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, pi / 64: the clamped cosine's zonal coefficients.
  constexpr std::array<double, kMaxDegree + 1> kCosine{
      kPi, 2.0 * kPi / 3.0, kPi / 4.0, 0.0, -kPi / 24.0, 0.0, kPi / 64.0};
  const auto harmonics = SphericalHarmonics(options_.degree, static_cast<float>(normal_mu),
                                            static_cast<float>(normal_cos_azimuth));
  std::array<float, kMaxMoments * kMaxBands> storage;
  const std::span<float> moments(storage.data(), moments_ * bands_);
  Interpolate(altitude_m, mu_s, moments);
  Bands<float> irradiance(bands_);
  for (int l = 0; l <= options_.degree; ++l) {
    for (int m = 0; m <= l; ++m) {
      const std::size_t i = MomentIndex(l, m);
      const float factor = harmonics[i] * static_cast<float>(kCosine[static_cast<std::size_t>(l)]);
      for (std::size_t band = 0; band < bands_; ++band)
        irradiance[band] += factor * moments[i * bands_ + band];
    }
  }
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] = std::max(irradiance[band], 0.0F);
  return irradiance;
}

Bands<float> DiffuseLight::SkyIrradiance(double altitude_m, double mu_s) const {
  Bands<float> irradiance(bands_);
  const double u = std::sqrt(std::clamp(altitude_m / medium_.atmosphere_height_m, 0.0, 1.0));
  VisitTaps(options_, u, SunCoordinate(mu_s), [&](std::size_t node, float weight) {
    const float* values = &values_[(node * channels() + moments_) * bands_];
    for (std::size_t band = 0; band < bands_; ++band) irradiance[band] += weight * values[band];
  });
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] = std::max(irradiance[band], 0.0F);
  return irradiance;
}

std::vector<float> DiffuseLight::ValuesAt(double altitude_coordinate, double sun_coordinate) const {
  std::vector<float> sum(channels() * bands_, 0.0F);
  VisitTaps(options_, altitude_coordinate, sun_coordinate, [&](std::size_t node, float weight) {
    const float* values = &values_[node * sum.size()];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * values[i];
  });
  return sum;
}

}  // namespace alpenglow
