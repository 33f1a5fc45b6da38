// SPDX-License-Identifier: MIT
// The example of README.md.
#include <alpenglow/lut/multiple_scattering/multiple_scattering.h>

#include <cstdio>

using namespace alpenglow::lut;  // and with it alpenglow::atmosphere

int main() {
  const Medium earth = MediumPreset("earth");
  const SingleScattering<float> air(earth);  // single scattering
  const MultipleScattering orders(earth);    // all higher orders, solved once
  // From 2 m; view and sun are 80 and 60 degrees from the zenith, and 90 degrees apart in azimuth.
  const ViewRay ray = RayFromAngles(2.0, 80.0, 90.0, 60.0);
  const auto samples = air.Sample(ray, {.nodes = 12, .split_ozone = false, .dark_samples = true});
  const auto once = air.Inscatter(air.Scatter(samples), ray.nu);
  const auto more = orders.InscatterAlong(samples, ray.nu);
  for (std::size_t i = 0; i < air.bands(); ++i)
    std::printf("%.0f nm: %.4f per steradian\n", earth.wavelengths_nm[i], once[i] + more[i]);
}
