// SPDX-License-Identifier: MIT
// How scattering polarises: what becomes of Stokes parameters. Q > 0 vibrates in the plane of
// scattering; the entries [1/sr] are those of every scatterer that is its own mirror image:
//
//   | I |     | a1  b1   0   0 |  | I |
//   | Q |  =  | b1  a2   0   0 |  | Q |
//   | U |     |  0   0  a3  b2 |  | U |
//   | V |     |  0   0 -b2  a4 |  | V |
//
// a1 is the phase function: what unpolarised light is scattered by. Hovenier, van der Mee and Domke
// (2004), "Transfer of Polarized Light in Planetary Atmospheres"; Q as in Hansen and Travis (1974),
// Space Sci. Rev. 16, 527.
#pragma once

#include <vector>

namespace alpenglow::atmosphere {

struct ScatteringMatrix {
  double a1 = 0.0, a2 = 0.0, a3 = 0.0, a4 = 0.0, b1 = 0.0, b2 = 0.0;  // [1/sr]
};

/// The largest depolarisation of molecules: of needles that light shakes along one axis alone.
inline constexpr double kLargestDepolarisation = 0.5;

/// Molecules that are not quite round: with c = cos_scattering, D = (1 - d) / (1 + d / 2),
/// D' = (1 - 2 d) / (1 - d) (Hansen and Travis 1974, 2.15 and 2.16)
///
///   4 pi a1 = 3/4 D (1 + c^2) + 1 - D   4 pi a3 = 3/2 D c       4 pi b1 = -3/4 D (1 - c^2)
///   4 pi a2 = 3/4 D (1 + c^2)           4 pi a4 = 3/2 D D' c    b2 = 0
///
/// @param depolarisation  d, in [0, kLargestDepolarisation]: of light scattered by 90 degrees, what
///   vibrates in the plane of scattering over what vibrates across it. @param cos_scattering  in
///   [-1, 1].
[[nodiscard]] ScatteringMatrix RayleighMatrix(double depolarisation, double cos_scattering);

/// Depolarisation of dry air with 360 ppm of carbon dioxide. Its King factor F, by which it scatters
/// more than round molecules of its refractivity would, is the mean of its gases' by volume: Bates
/// (1984), Planet. Space Sci. 32, 785, as Bodhaine et al. (1999), J. Atmos. Oceanic Technol. 16,
/// 1854, have it (equations 5, 6 and 23); d = 6 (F - 1) / (7 F + 3). About 0.028 in the visible.
/// @param wavelength_nm  in [200, 4000]: beyond what was measured to the red F hardly changes.
[[nodiscard]] double AirDepolarisation(double wavelength_nm);

/// What spheres do to polarised light, beside their phase function: ratios to a1 at the same number
/// of scattering angles, uniform from 0 to 180 degrees, linear between. a2 = a1 and a4 = a3.
struct SphereRatios {
  std::vector<double> a3, b1, b2;
};

/// @param phase_per_sr  a1. @param cos_scattering  in [-1, 1].
[[nodiscard]] ScatteringMatrix SphereMatrix(const SphereRatios& ratios, double phase_per_sr,
                                            double cos_scattering);

}  // namespace alpenglow::atmosphere
