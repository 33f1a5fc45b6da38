// SPDX-License-Identifier: MIT
// What glows.
#pragma once

namespace alpenglow::atmosphere {

/// Planck's spectral radiance [W m^-2 sr^-1 nm^-1]. Constants of CODATA 2018, which are exact.
[[nodiscard]] double BlackBodyRadiance(double wavelength_nm, double temperature_k);

}  // namespace alpenglow::atmosphere
