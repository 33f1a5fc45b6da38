// SPDX-License-Identifier: MIT
// Legendre coefficients of phase functions for tests of layers.
#pragma once

#include <cmath>
#include <vector>

namespace alpenglow::renderer {

/// Returns the coefficients of the phase function of Henyey and Greenstein, to 1e-9.
inline std::vector<double> LobeMoments(double g) {
  std::vector<double> chi{1.0};
  while (std::abs(chi.back()) > 1e-9) chi.push_back(chi.back() * g);
  return chi;
}

/// Coefficients of Rayleigh's phase function without depolarisation.
inline const std::vector<double> kMoleculeMoments{1.0, 0.0, 0.1};

}  // namespace alpenglow::renderer
