// SPDX-License-Identifier: MIT
// What water and ice do to light inside them.
#pragma once

namespace alpenglow::atmosphere {

/// Absorption coefficient of pure water [1/m]: Pope, Fry (1997), Appl. Opt. 36, 8710, and from
/// 730 nm Smith, Baker (1981), Appl. Opt. 20, 177; linear in a 10 nm table from 380 to 750 nm, its
/// end values beyond.
[[nodiscard]] double WaterAbsorption(double wavelength_nm);

/// Scattering coefficient of pure sea water [1/m], half of it backwards: 0.00288
/// (lambda / 500 nm)^-4.32, Morel (1974), Optical Properties of Pure Water and
/// Pure Sea Water.
[[nodiscard]] double SeaWaterScattering(double wavelength_nm);

/// Absorption coefficient of pure ice [1/m], 4 pi k / lambda: Warren, Brandt (2008), J. Geophys.
/// Res. 113, D14220; k linear in a 10 nm table from 380 to 750 nm, its end values beyond.
[[nodiscard]] double IceAbsorption(double wavelength_nm);

}  // namespace alpenglow::atmosphere
