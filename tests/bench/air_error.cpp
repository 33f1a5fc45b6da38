// SPDX-License-Identifier: MIT
// Error of the fast path of single scattering against the judge, by height of the sun: root mean
// square, 99th percentile and maximum of the relative error over views from the ground, aircraft
// and space. Run by hand; results are in README.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/judge.h"
#include "atmosphere/single_scattering.h"

namespace alpenglow {
namespace {

// Point number i of a two-base Halton sequence.
double Halton(int i, int base) {
  double value = 0.0, digit = 1.0;
  for (; i > 0; i /= base) value += (digit /= base) * (i % base);
  return value;
}

struct Regime {
  const char* name;
  double low_deg, high_deg;
};

ViewRay RayNumber(int i, const Regime& regime) {
  constexpr double kAltitudes_m[] = {2.0, 1500.0, 10000.0};
  const double elevation = regime.low_deg + (regime.high_deg - regime.low_deg) * Halton(i, 2);
  // Half of the views within 10 degrees of the horizontal, where the air is long.
  const double view = i % 2 == 0 ? 90.0 * Halton(i, 3) : 80.0 + 10.0 * Halton(i, 3);
  return RayFromAngles(kAltitudes_m[i % 3], view, 180.0 * Halton(i, 5), 90.0 - elevation);
}

void Report(const Medium& medium, const Regime& regime, const Sampling& sampling) {
  constexpr int kRays = 600;
  const AirIntegrator<float> air(medium);
  std::vector<double> errors;
  for (int i = 1; i <= kRays; ++i) {
    const ViewRay ray = RayNumber(i, regime);
    const auto truth = judge::SingleScatteringAlong(medium, ray);
    const auto fast = air.Inscatter(air.Scatter(air.Sample(ray, sampling)), ray.nu);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      if (truth.inscatter[band] < 1e-12) continue;
      errors.push_back(std::abs(static_cast<double>(fast[band]) / truth.inscatter[band] - 1.0));
    }
  }
  std::sort(errors.begin(), errors.end());
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  fmt::print("| {} | {} | {}{} | {:.1e} | {:.1e} | {:.1e} |\n", medium.name, regime.name,
             sampling.nodes, sampling.split_ozone ? ", split at ozone" : "",
             std::sqrt(squares / static_cast<double>(errors.size())),
             errors[errors.size() * 99 / 100], errors.back());
}

}  // namespace
}  // namespace alpenglow

int main() {
  using namespace alpenglow;
  fmt::print("| air | sun | nodes a panel | rms | 99 % | max |\n|---|---|---|---|---|---|\n");
  for (const char* name : {"earth", "hazy"}) {
    for (const Regime& regime :
         {Regime{"5 to 90 deg", 5.0, 90.0}, {"0 to 5 deg", 0.0, 5.0}, {"-6 to 0 deg", -6.0, 0.0}}) {
      for (const Sampling& sampling :
           {Sampling{8, false}, Sampling{12, false}, Sampling{16, true}}) {
        Report(MediumPreset(name), regime, sampling);
      }
    }
  }
}
