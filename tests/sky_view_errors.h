// SPDX-License-Identifier: MIT
// Errors of a SkyView against direct evaluation of its directions: AirIntegrator in double with
// many nodes, and DiffuseLight along many nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "atmosphere/constants.h"
#include "atmosphere/halton.h"
#include "lut/eval.h"
#include "lut/sky_view.h"

namespace alpenglow {

/// Relative errors over directions and bands, smallest first.
struct SkyViewErrors {
  std::vector<double> sorted;
  [[nodiscard]] double Percentile(double percent) const {
    return sorted.empty() ? 0.0
                          : sorted[static_cast<std::size_t>(
                                percent / 100.0 * static_cast<double>(sorted.size() - 1))];
  }
  [[nodiscard]] double Rms() const {
    double sum = 0.0;
    for (const double error : sorted) sum += error * error;
    return sorted.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(sorted.size()));
  }
};

/// The direct evaluation.
class DirectSky {
 public:
  DirectSky(const Medium& medium, const DiffuseLight& diffuse)
      : exact_(medium), quick_(medium), diffuse_(diffuse) {}

  [[nodiscard]] Bands<double> Radiance(const ViewRay& ray) const {
    Bands<double> light = exact_.Inscatter(
        exact_.Scatter(exact_.Sample(ray, {.nodes = 32, .split_ozone = true})), ray.nu);
    const Bands<float> rest =
        diffuse_.InscatterAlong(quick_.Sample(ray, {.nodes = 32, .dark_samples = true}), ray.nu);
    for (std::size_t band = 0; band < light.count; ++band) light[band] += double{rest[band]};
    if (const auto mu_s = SunOnGround(exact_.medium(), ray)) {
      const Bands<double> through = exact_.TransmittanceAlong(ray);
      const Bands<double> sun = exact_.TransmittanceToSpace(0.0, *mu_s);
      const Bands<float> sky = diffuse_.SkyIrradiance(0.0, *mu_s);
      for (std::size_t band = 0; band < light.count; ++band) {
        light[band] += through[band] * exact_.medium().ground_albedo[band] / kPi *
                       (double{sky[band]} + std::max(*mu_s, 0.0) * sun[band]);
      }
    }
    return light;
  }

 private:
  AirIntegrator<double> exact_;
  AirIntegrator<float> quick_;
  const DiffuseLight& diffuse_;
};

/// Directions all over the sphere, every other one within 10 degrees of the horizon. Errors are
/// relative to the radiance, or to a thousandth of the mean radiance where that is more.
inline SkyViewErrors ErrorsOf(const SkyView& view, const DirectSky& direct, double altitude_m,
                              double mu_s, int directions) {
  struct Pair {
    double exact, error;
  };
  std::vector<Pair> pairs;
  double mean = 0.0;
  for (int i = 1; i <= directions; ++i) {
    const double u = Halton(i, 2), azimuth = kPi * Halton(i, 3);
    const double horizon = view.map().horizon_zenith_angle_rad();
    const double zenith =
        i % 2 == 0 ? std::acos(1.0 - 2.0 * u) : std::clamp(horizon + 0.35 * (u - 0.7501), 0.0, kPi);
    const double mu = std::cos(zenith);
    const double nu =
        mu * mu_s + std::sin(zenith) * std::sqrt(1.0 - mu_s * mu_s) * std::cos(azimuth);
    const Bands<double> exact = direct.Radiance({altitude_m, mu, mu_s, std::clamp(nu, -1.0, 1.0)});
    const Bands<float> seen = view.Radiance(zenith, azimuth);
    for (std::size_t band = 0; band < exact.count; ++band) {
      pairs.push_back({exact[band], double{seen[band]} - exact[band]});
      mean += exact[band];
    }
  }
  mean /= static_cast<double>(pairs.size());
  SkyViewErrors errors;
  for (const Pair& pair : pairs)
    errors.sorted.push_back(std::abs(pair.error) / std::max(pair.exact, 1e-3 * mean));
  std::sort(errors.sorted.begin(), errors.sorted.end());
  return errors;
}

}  // namespace alpenglow
