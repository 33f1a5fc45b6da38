// SPDX-License-Identifier: MIT
// Light scattered by spheres of any size: Lorenz-Mie theory, slow and exact. It judges the fits
// that stand for it (fog), and makes tables (dust of Mars).
//
// Formulas: Bohren and Huffman (1983), "Absorption and Scattering of Light by Small Particles",
// chapter 4; the logarithmic derivative by downward recurrence, psi and chi by upward recurrence.
#pragma once

#include <complex>
#include <vector>

#include "atmosphere/air/phase.h"

namespace alpenglow::atmosphere {

/// One sphere, or many: efficiencies are cross sections over the (mean) area of the shadow.
struct SphereScattering {
  double extinction_efficiency = 0.0;
  double scattering_efficiency = 0.0;
  double mean_cosine = 0.0;
  std::vector<double> per_sr;  // phase function at the angles asked for; integral over the sphere 1
  SphereRatios polarised;      // of the scattering matrix to it, at the same angles
};

/// @param index   refractive index n + i k of the sphere relative to the air; n > 0, k >= 0.
/// @param size_parameter  circumference over wavelength, in [1e-3, 1e4].
/// @param angle_rad  scattering angles. Throws InputError for another size or index.
[[nodiscard]] SphereScattering ScatterBySphere(std::complex<double> index, double size_parameter,
                                               const std::vector<double>& angle_rad);

/// Sizes after Hansen (1971), J. Atmos. Sci. 28, 1400: n(r) ~ r^((1 - 3 v) / v) exp(-r / (a v)).
struct SizeDistribution {
  double effective_radius_um = 1.0;  // a > 0
  double effective_variance = 0.1;   // v in (0, 0.5)
};

/// Spheres of many sizes, integrated over 400 radii, uniform in their logarithm, within twelve
/// standard deviations of the effective radius. @param wavelength_nm  in the air.
[[nodiscard]] SphereScattering ScatterBySpheres(std::complex<double> index,
                                                const SizeDistribution& sizes, double wavelength_nm,
                                                const std::vector<double>& angle_rad);

}  // namespace alpenglow::atmosphere
