// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/polarised_scattering.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/moment_grid.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {

double AzimuthCosineOrAhead(double mu, double mu_s, double nu) {
  const double sines = SineOf(mu) * SineOf(mu_s);
  return sines < 1e-6 ? 1.0 : shared::AzimuthCosine(mu, mu_s, nu, sines);
}

PolarisedLight PolarisedOnce(const Medium& medium, const ScatteredOnce<float>& once,
                             const ViewRay& ray) {
  const double cosine = AzimuthCosineOrAhead(ray.mu, ray.mu_s, ray.nu);
  // Components of the sun's direction on l and h of polarised_scattering.h.
  const double in_l = ray.mu * cosine * SineOf(ray.mu_s) - SineOf(ray.mu) * ray.mu_s;
  const double in_h = -SineOf(cosine) * SineOf(ray.mu_s);
  PolarisedLight light{Spectrum(once.rayleigh.size()), Spectrum(once.rayleigh.size())};
  for (std::size_t band = 0; band < once.rayleigh.size(); ++band) {
    const double share = 3.0 / (16.0 * kPi) * 10.0 *
                         static_cast<double>(RayleighChi2(medium, band) * once.rayleigh[band]);
    light.q[band] = static_cast<float>(share * (in_h - in_l) * (in_h + in_l));
    light.u[band] = static_cast<float>(2.0 * share * in_l * in_h);
  }
  return light;
}

}  // namespace alpenglow::lut
