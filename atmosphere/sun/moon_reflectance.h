// SPDX-License-Identifier: MIT
// How much sunlight the moon sends back, by phase and wavelength.
//
// Of the whole disk, A = pi E_moon / (E_sun Omega), by the lunar calibration of ROLO (Kieffer,
// Stone 2005, Astron. J. 129, 2887, equation 10 and table 4):
//
//   ln A = a0 + a1 g + a2 g^2 + a3 g^3 + d1 exp(-g/4.06054) + d2 exp(-g/12.8802)
//          + d3 cos((g + 30.5858)/16.7498)
//
// with the phase angle g in radians in the polynomial and in degrees elsewhere: a curve with an
// opposition surge, of ground that is redder than the sun and bluer in full light. What libration,
// and maria east or west of the terminator, change (6 % in the quarters) is left out.
#pragma once

namespace alpenglow::atmosphere {

/// Measured from 1.55 to 97 degrees; beyond, the same curve, within 12 % of that of Krisciunas
/// and Schaefer (1991) from 7 to 145 degrees; it ends at 150.
/// @param wavelength_nm  in [350, 1060], linear between nine filters; beyond as at the ends.
[[nodiscard]] double MoonReflectance(double phase_angle_rad, double wavelength_nm);

}  // namespace alpenglow::atmosphere
