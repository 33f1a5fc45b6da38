// SPDX-License-Identifier: MIT
#include "lut/diffuse/missing_degrees.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "lut/diffuse/spherical_harmonics.h"

namespace alpenglow::lut {
namespace {

// Beyond it the peak of any dust or haze is narrower than half a degree of arc times its share.
constexpr int kLastMissingDegree = 64;

// P_l(nu) for l = 0 ... kLastMissingDegree.
std::vector<double> LegendreValues(double nu) {
  std::vector<double> values{1.0, nu};
  for (int l = 1; l < kLastMissingDegree; ++l) {
    const auto i = static_cast<std::size_t>(l);
    values.push_back(((2.0 * l + 1.0) * nu * values[i] - l * values[i - 1]) / (l + 1.0));
  }
  return values;
}

// What |P_l(cos theta)| stays below: 1, and sqrt(2 / (pi (l + 1/2) sin theta)) (Bernstein).
double Envelope(int l, double nu) {
  const double sine = std::sqrt(std::max(1.0 - nu * nu, 1e-12));
  return std::min(1.0, std::sqrt(2.0 / (kPi * (l + 0.5) * sine)));
}

}  // namespace

MissingDegrees::MissingDegrees(const Medium& medium, int degree)
    : bands_(medium.wavelengths_nm.size()),
      degree_(degree),
      chi_(MieLegendreCoefficients(medium, kLastMissingDegree)) {}

std::vector<double> MissingDegrees::Along(const AirConstants<float>& air,
                                          const RaySamples<float>& samples, double nu) const {
  std::vector<double> legendre = LegendreValues(nu);
  legendre.push_back(Envelope(degree_ + 1, nu));
  std::vector<double> light;
  for (std::size_t band = 0; band < bands_; ++band)
    light.push_back(AlongBand(air, band, samples, legendre));
  return light;
}

double MissingDegrees::AlongBand(const AirConstants<float>& air, std::size_t band,
                                 const RaySamples<float>& samples,
                                 const std::vector<double>& legendre) const {
  const double scattering = static_cast<double>(air.mie_scattering[band]);
  if (scattering == 0.0) return 0.0;
  double sum = 0.0, envelope = 0.0;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const float depth =
        OpticalDepthOf(ExtinctionAt(air, band), {samples.view_rayleigh[i] + samples.sun_rayleigh[i],
                                                 samples.view_mie[i] + samples.sun_mie[i],
                                                 samples.view_ozone[i] + samples.sun_ozone[i]});
    const double light = static_cast<double>(samples.weight[i] * samples.lit[i] *
                                             samples.mie_density[i] * std::exp(-depth)) *
                         scattering;
    if (!(light > 0.0)) continue;
    const double tau = scattering * static_cast<double>(samples.view_mie[i] + samples.sun_mie[i]);
    for (int l = degree_ + 1; l <= kLastMissingDegree; ++l) {
      const auto at = static_cast<std::size_t>(l);
      const double chi = chi_[at * bands_ + band];
      const double part = light * (2.0 * l + 1.0) / (4.0 * kPi) * chi * std::expm1(chi * tau);
      sum += part * legendre[at];
      if (l == degree_ + 1) envelope += std::abs(part) * legendre.back();
    }
  }
  return std::abs(sum) + envelope;
}

}  // namespace alpenglow::lut
