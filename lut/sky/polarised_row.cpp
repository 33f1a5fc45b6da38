// SPDX-License-Identifier: MIT
#include "lut/sky/polarised_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "atmosphere/number/constants.h"

namespace alpenglow::lut {
namespace {

constexpr int kSteps = 48;  // over half a turn

PolarisedLight Along(const AirIntegrator<float>& air, const DiffuseLight& diffuse,
                     const ViewRay& ray) {
  const RaySamples<float> samples = air.Sample(ray, {.nodes = 16, .dark_samples = true});
  PolarisedLight light{Bands<float>(air.bands()), Bands<float>(air.bands())};
  if (samples.count == 0 || !air.medium().polarised) return light;
  light = PolarisedOnce(air.medium(), air.Scatter(samples), ray);
  const PolarisedLight more = diffuse.PolarisationAlong(samples, ray.nu);
  for (std::size_t band = 0; band < air.bands(); ++band) {
    light.q[band] += more.q[band];
    light.u[band] += more.u[band];
  }
  return light;
}

}  // namespace

PolarisedRow::PolarisedRow(const AirIntegrator<float>& air, const DiffuseLight& diffuse,
                           double altitude_m, double mu_s, double zenith_angle_rad) {
  const double mu = std::cos(zenith_angle_rad);
  const double sines =
      std::sin(zenith_angle_rad) * std::sqrt(std::max((1.0 - mu_s) * (1.0 + mu_s), 0.0));
  for (int k = 0; k <= kSteps; ++k) {
    const double nu = std::clamp(mu * mu_s + sines * std::cos(kPi * k / kSteps), -1.0, 1.0);
    nodes_.push_back(Along(air, diffuse, {std::max(altitude_m, 0.0), mu, mu_s, nu}));
  }
}

// Lagrange's cubic through the four nodes around.
PolarisedLight PolarisedRow::At(double azimuth_rad) const {
  const double turn = std::remainder(azimuth_rad, 2.0 * kPi) / kPi * kSteps;
  const int first = static_cast<int>(std::floor(turn));
  const double t = turn - first;
  const std::array<double, 4> weight{
      -t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
      -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
  const std::size_t bands = nodes_.front().q.count;
  PolarisedLight light{Bands<float>(bands), Bands<float>(bands)};
  for (int i = 0; i < 4; ++i) {
    int k = first - 1 + i;
    if (k > kSteps) k -= 2 * kSteps;  // the same azimuth
    if (k < -kSteps) k += 2 * kSteps;
    const PolarisedLight& node = nodes_[static_cast<std::size_t>(std::abs(k))];
    const auto of_q = static_cast<float>(weight.at(static_cast<std::size_t>(i)));
    const float of_u = k < 0 ? -of_q : of_q;
    for (std::size_t band = 0; band < bands; ++band) {
      light.q[band] += of_q * node.q[band];
      light.u[band] += of_u * node.u[band];
    }
  }
  return light;
}

}  // namespace alpenglow::lut
