// SPDX-License-Identifier: MIT
#include "atmosphere/colour/black_body.h"

#include <cmath>

namespace alpenglow::atmosphere {

double BlackBodyRadiance(double wavelength_nm, double temperature_k) {
  constexpr double kC1_w_m2_per_sr = 1.191042972397188e-16;  // 2 h c^2
  constexpr double kC2_m_k = 1.438776877503933e-2;           // h c / k
  const double metres = 1e-9 * wavelength_nm;
  const double per_metre =
      kC1_w_m2_per_sr / std::pow(metres, 5.0) / std::expm1(kC2_m_k / (metres * temperature_k));
  return 1e-9 * per_metre;
}

}  // namespace alpenglow::atmosphere
