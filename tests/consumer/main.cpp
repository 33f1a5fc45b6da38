// SPDX-License-Identifier: MIT
// Uses one thing of each installed library; exits 0 when they answer sensibly.
#include <alpenglow/atmosphere/ray/single_scattering.h>
#include <alpenglow/lut/image/image.h>
#include <alpenglow/lut/multiple_scattering/multiple_scattering.h>

int main() {
  const alpenglow::atmosphere::SingleScattering<float> air(
      alpenglow::atmosphere::MediumPreset("earth"));
  const float zenith = air.TransmittanceToSpace(0.0, 1.0)[0];
  const double rayleigh = alpenglow::lut::LegendreCoefficients(
      {.kind = alpenglow::atmosphere::PhaseKind::kRayleigh}, 2)[2];
  const bool sensible = zenith > 0.5F && zenith < 1.0F && rayleigh > 0.0999 && rayleigh < 0.1001 &&
                        alpenglow::lut::ExposureScale(15.0) > 0.0;
  return sensible ? 0 : 1;
}
