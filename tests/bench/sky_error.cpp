// SPDX-License-Identifier: MIT
// Prints a table of the errors of SkyView, and of the time to build it, for several altitudes and
// elevations of the sun.
//   sky_error [sky_rows ground_rows azimuths ray_nodes [preset]]
#include <fmt/core.h>

#include <cstdlib>
#include <ctime>

#include "tests/fixtures/sky_view_errors.h"

namespace alpenglow::lut {
namespace {

void Row(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
         const DirectSky& direct, double altitude_m, double elevation_deg,
         const SkyViewSize* fixed) {
  const double mu_s = std::sin(elevation_deg * kRadiansPerDegree);
  const SkyViewSize size =
      fixed != nullptr ? *fixed : SkyViewSizeFor(air.medium(), altitude_m, mu_s);
  const std::clock_t start = std::clock();
  const SkyView view(air, multiple_scattering, altitude_m, mu_s, size);
  const double ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const SkyViewErrors errors = ErrorsOf(view, direct, altitude_m, mu_s, 3000);
  fmt::print(
      "{:8.0f} m {:6.1f} deg  {:3}+{:2} x {:2}  {:7.2f} ms  rms {:.5f}  p99 {:.5f}  max {:.5f}\n",
      altitude_m, elevation_deg, size.sky_rows, size.ground_rows, size.azimuths, ms, errors.Rms(),
      errors.Percentile(99.0), errors.Percentile(100.0));
}

}  // namespace
}  // namespace alpenglow::lut

int main(int argc, char** argv) {
  using namespace alpenglow::lut;
  SkyViewSize size;
  const bool fixed = argc > 4 && std::atoi(argv[1]) > 0;
  if (fixed) {
    size = {.sky_rows = std::atoi(argv[1]),
            .ground_rows = std::atoi(argv[2]),
            .azimuths = std::atoi(argv[3]),
            .ray_nodes = std::atoi(argv[4])};
  }
  const Medium medium = MediumPreset(argc > 5 ? argv[5] : "earth");
  const SingleScattering<float> air(medium);
  const MultipleScattering multiple_scattering(medium);
  const DirectSky direct(medium, multiple_scattering);
  for (const double altitude_m : {2.0, 10e3, 40e3, 400e3}) {
    for (const double elevation_deg : {60.0, 10.0, 1.0, -1.0, -4.0, -10.0})
      Row(air, multiple_scattering, direct, altitude_m, elevation_deg, fixed ? &size : nullptr);
  }
}
