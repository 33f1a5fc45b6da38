// SPDX-License-Identifier: MIT
// Named aerosols: the mixtures of OPAC at 80 % relative humidity.
//
// Hess, Koepke and Schult (1998), "Optical Properties of Aerosols and Clouds: The Software Package
// OPAC", Bull. Amer. Meteor. Soc. 79, 831-844. Numbers: data/opac_aerosol_80rh.csv and
// data/opac_phase_80rh.csv.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere {

/// Optical properties of an aerosol in one exponential layer, on a wavelength set, at altitude 0.
struct AerosolOptics {
  std::vector<double> extinction_per_m, scattering_per_m;
  double extinction_550_per_m = 0.0;
  /// Scale height of the single exponential that has OPAC's extinction at the ground and OPAC's
  /// column. OPAC's own profile, exp(-h / Z), ends at the top of the mixing layer.
  double scale_height_m = 0.0;
  std::vector<PhaseFunction> phase;  // one for all wavelengths, or one per wavelength
};

/// Returns "continental_clean", "desert" and so on, in the order of the table.
[[nodiscard]] std::vector<std::string> AerosolMixtureNames();

/// Returns a mixture with its tabulated load. Between 350 and 900 nm, extinction is interpolated in
/// the logarithms of wavelength and extinction, and albedo linearly. Beyond this range extinction
/// continues with the last slope and albedo with the last value. The phase functions are those of
/// AerosolMixturePhase. Throws InputError for an unknown name.
/// @param wavelengths_nm  ascending.
[[nodiscard]] AerosolOptics AerosolMixture(std::string_view name,
                                           const std::vector<double>& wavelengths_nm);

/// Returns the phase functions of a mixture, one per wavelength. continental_clean,
/// continental_average, urban, desert and maritime_clean are tabulated (450, 550, 650 nm; linear
/// between, constant beyond). continental_polluted is derived from the particles that it shares
/// with the first three. All others use the Cornette-Shanks function with the mean cosine of the
/// mixture at each wavelength, to 1e-9. Throws InputError for an unknown name.
/// @param wavelengths_nm  ascending.
[[nodiscard]] std::vector<PhaseFunction> AerosolMixturePhase(
    std::string_view name, const std::vector<double>& wavelengths_nm);

/// Returns the g in [0, 1) for which the Cornette-Shanks phase function has this mean cosine.
[[nodiscard]] double CornetteShanksG(double mean_cosine);

}  // namespace alpenglow::atmosphere
