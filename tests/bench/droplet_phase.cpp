// SPDX-License-Identifier: MIT
// Computes the phase functions of cloud droplets in renderer/data:
//
//   droplet_phase > renderer/data/droplet_phase.csv
//
// Spheres of water with the size distribution of Hansen (1971), J. Atmos. Sci. 28, 1400, and his
// effective variance of fair-weather cumulus, 1/9. Water absorbs too little visible light to matter
// here, so that the phase function depends on the size parameter 2 pi r_eff / wavelength and on the
// refractive index. The index is that of 400, 550 and 700 nm (Hale and Querry 1973, Appl. Opt. 12,
// 555; in between it is linear to 0.0003). Each of 8000 spheres, uniform in ln r, is computed once for
// every index and serves all size parameters.
#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/lorenz_mie.h"

namespace {

using namespace alpenglow::atmosphere;

constexpr std::array kIndices{1.339, 1.333, 1.331};
constexpr double kVariance = 1.0 / 9.0;
constexpr double kSmallest = 1.0, kLargest = 2520.0;  // size parameters of spheres
constexpr std::size_t kSpheres = 8000;

/// Returns angles that are dense where the phase functions are steep: at the forward peak, and at
/// the bow and the glory.
std::vector<double> Angles_deg() {
  std::vector<double> angles;
  constexpr int kForward = 160;
  for (int i = 0; i < kForward; ++i) angles.push_back(30.0 * std::pow(double(i) / kForward, 3));
  for (int i = 30; i < 130; ++i) angles.push_back(i);
  for (int i = 260; i <= 360; ++i) angles.push_back(0.5 * i);
  return angles;
}

/// Returns the effective size parameters of the columns.
std::vector<double> EffectiveSizes() {
  std::vector<double> sizes;
  for (int i = 0; i < 14; ++i) sizes.push_back(25.0 * std::exp2(i / 3.0));
  return sizes;
}

double SphereAt(std::size_t i) {
  return kSmallest *
         std::pow(kLargest / kSmallest, (static_cast<double>(i) + 0.5) / double(kSpheres));
}

/// Returns the scattering cross section of spheres per unit of ln r, for a relative radius q.
double Weight(double q, double scattering_efficiency) {
  return std::exp(std::log(q) / kVariance - (q - 1.0) / kVariance) * scattering_efficiency;
}

/// Returns the phase functions at angles by column.
std::vector<std::vector<double>> Columns(double index, const std::vector<double>& sizes,
                                         const std::vector<double>& angles_rad) {
  std::vector<SphereScattering> spheres(kSpheres);
  tbb::parallel_for(std::size_t{0}, kSpheres, [&](std::size_t i) {
    spheres[i] = ScatterBySphere({index, 0.0}, SphereAt(i), angles_rad);
    spheres[i].polarised = {};
  });
  std::vector<std::vector<double>> columns;
  for (const double size : sizes) {
    std::vector<double> light(angles_rad.size(), 0.0);
    double all = 0.0;
    for (std::size_t i = 0; i < kSpheres; ++i) {
      const double weight = Weight(SphereAt(i) / size, spheres[i].scattering_efficiency);
      for (std::size_t k = 0; k < light.size(); ++k) light[k] += weight * spheres[i].per_sr[k];
      all += weight;
    }
    for (double& each : light) each /= all;
    columns.push_back(std::move(light));
  }
  return columns;
}

}  // namespace

int main() {
  const std::vector<double> angles = Angles_deg(), sizes = EffectiveSizes();
  std::vector<double> radians;
  for (const double angle : angles) radians.push_back(angle * kRadiansPerDegree);
  std::vector<std::vector<double>> columns;
  fmt::print(
      "# Phase functions of water droplets [1/sr] by scattering angle; the names of the other "
      "columns are effective size parameters and refractive indices. Computed by "
      "tests/bench/droplet_phase.cpp, which names the sources.\nangle_deg");
  for (const double index : kIndices) {
    for (const double size : sizes) fmt::print(",{:.4f}_{}", size, index);
    for (auto& column : Columns(index, sizes, radians)) columns.push_back(std::move(column));
  }
  fmt::print("\n");
  for (std::size_t k = 0; k < angles.size(); ++k) {
    fmt::print("{:.5g}", angles[k]);
    for (const auto& column : columns) fmt::print(",{:.4g}", column[k]);
    fmt::print("\n");
  }
}
