// SPDX-License-Identifier: MIT
// Lorenz-Mie theory: exact but slow computation of the light scattered by spheres of any size. It
// is the reference for the fitted phase function of fog, and the source of the tables for the dust
// of Mars.
//
// Formulas: Bohren and Huffman (1983), "Absorption and Scattering of Light by Small Particles",
// chapter 4; the logarithmic derivative by downward recurrence, psi and chi by upward recurrence.
#pragma once

#include <complex>
#include <vector>

#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere {

/// Scattering by one sphere or by an ensemble. Efficiencies are cross sections divided by the
/// (mean) geometric cross section.
struct SphereScattering {
  double extinction_efficiency = 0.0;
  double scattering_efficiency = 0.0;
  double mean_cosine = 0.0;
  std::vector<double> per_sr;  // phase function at the requested angles; integral over the sphere 1
  SphereRatios polarised;      // ratios of the scattering matrix to it, at the same angles
};

/// Returns the scattering by one sphere. Throws InputError for a size or index out of range.
/// @param index   refractive index n + i k of the sphere relative to the air; n > 0, k >= 0.
/// @param size_parameter  circumference over wavelength, in [1e-3, 1e4].
/// @param angle_rad  scattering angles.
[[nodiscard]] SphereScattering ScatterBySphere(std::complex<double> index, double size_parameter,
                                               const std::vector<double>& angle_rad);

/// Size distribution of Hansen (1971), J. Atmos. Sci. 28, 1400: n(r) ~ r^((1 - 3 v) / v)
/// exp(-r / (a v)).
struct SizeDistribution {
  double effective_radius_um = 1.0;  // a > 0
  double effective_variance = 0.1;   // v in (0, 0.5)
};

/// Returns the scattering by spheres with a size distribution, integrated over 400 radii that are
/// uniform in their logarithm, within twelve standard deviations of the effective radius.
/// @param wavelength_nm  in the air.
[[nodiscard]] SphereScattering ScatterBySpheres(std::complex<double> index,
                                                const SizeDistribution& sizes, double wavelength_nm,
                                                const std::vector<double>& angle_rad);

}  // namespace alpenglow::atmosphere
