// SPDX-License-Identifier: MIT
// Aerosols that have names: the mixtures of OPAC at 80 % relative humidity.
//
// Hess, Koepke and Schult (1998), "Optical Properties of Aerosols and Clouds: The Software Package
// OPAC", Bull. Amer. Meteor. Soc. 79, 831-844. Numbers: data/opac_aerosol_80rh.csv and
// data/opac_phase_80rh.csv.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/air/phase.h"

namespace alpenglow::atmosphere {

/// An aerosol in one exponential layer, on a wavelength set; at altitude 0.
struct AerosolOptics {
  std::vector<double> extinction_per_m, scattering_per_m;
  double extinction_550_per_m = 0.0;
  /// Of the one exponential that has OPAC's extinction at the ground and its column: OPAC's own
  /// profile, exp(-h / Z), ends at the top of the mixing layer.
  double scale_height_m = 0.0;
  std::vector<PhaseFunction> phase;  // one, or one per wavelength
};

/// "continental_clean", "desert" and so on, in the order of the table.
[[nodiscard]] std::vector<std::string> AerosolMixtureNames();

/// A mixture with its own load. Extinction is interpolated in the logarithms of both between 350
/// and 900 nm, albedo linearly; beyond them both are continued with the last slope (extinction) and
/// value (albedo); phase functions are those of AerosolMixturePhase. Throws InputError for another
/// name. @param wavelengths_nm  ascending.
[[nodiscard]] AerosolOptics AerosolMixture(std::string_view name,
                                           const std::vector<double>& wavelengths_nm);

/// A mixture's phase functions, one per wavelength. continental_clean, continental_average, urban,
/// desert and maritime_clean are tabulated (450, 550, 650 nm; linear between, constant beyond), and
/// continental_polluted follows from the particles that it shares with the first three; the others
/// have that of Cornette and Shanks with the mixture's mean cosine at each wavelength, to 1e-9.
/// Throws InputError for another name. @param wavelengths_nm  ascending.
[[nodiscard]] std::vector<PhaseFunction> AerosolMixturePhase(
    std::string_view name, const std::vector<double>& wavelengths_nm);

/// The g for which the phase function of Cornette and Shanks has this mean cosine, in [0, 1).
[[nodiscard]] double CornetteShanksG(double mean_cosine);

}  // namespace alpenglow::atmosphere
