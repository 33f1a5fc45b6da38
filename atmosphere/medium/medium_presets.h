// SPDX-License-Identifier: MIT
// Functions that make a medium: from a preset or a file, on other wavelengths, and with an ozone
// column in Dobson units, as weather services give it.
//
// Provides AirChoice, the changes of a medium by a user (aerosol, ozone, ground), and the
// visibility and ozone of a medium.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "atmosphere/medium/medium.h"

namespace alpenglow::atmosphere {

/// Returns the absorption coefficient at the peak of the layer [1/m] for a column of
/// `column_dobson` (1 DU = 2.6867811e20 molecules per m^2): column times cross section over the
/// equivalent depth of the layer.
/// @param wavelength_nm  in [360, 830]; returns 0 where the cross section has no data.
[[nodiscard]] double OzoneAbsorptionAtPeak(double column_dobson, const OzoneLayer& layer,
                                           double wavelength_nm);

/// Returns the medium on WavelengthSet(bands): its preset (from Medium::name) on these bands, times
/// the ratio of the medium to its preset, linear between the medium's wavelengths. The result is
/// exact for an unmodified preset, and if the differences are factors common to all wavelengths
/// (ozone in Dobson units, visibility). Returns std::nullopt if the preset is not known, has no
/// values at these wavelengths, or is zero where the medium is not.
[[nodiscard]] std::optional<Medium> OnBands(const Medium& medium, int bands);

/// Returns MediumPreset of a name in MediumPresetNames, else ReadMedium of the file, whose name is
/// relative to `folder`. Throws InputError as these two functions do; for a word that is neither,
/// the message names the nearest preset, or all presets.
[[nodiscard]] Medium MediumFromChoice(const std::string& preset_or_file, const MediumUse& use,
                                      const std::filesystem::path& folder = {});

/// Changes of a medium; unset values keep those of the medium.
struct AirChoice {
  double aerosol = 1.0;                 // factor on the aerosol of the medium, [0, 1000]
  std::optional<double> ozone_du;       // of the whole column, [0, 10000]
  std::optional<double> ground_albedo;  // [0, 1], in all bands
};

/// Returns the changed medium. Throws InputError that names the value out of range.
[[nodiscard]] Medium Changed(Medium medium, const AirChoice& choice);

/// Returns the extinction coefficients of molecules and aerosol at altitude 0 and 550 nm [1/m]. They
/// are interpolated linearly in the logarithms of wavelength and coefficient.
[[nodiscard]] double MoleculesAt550_per_m(const Medium& medium);
[[nodiscard]] double AerosolAt550_per_m(const Medium& medium);

/// Returns Koschmieder's visibility at altitude 0 and 550 nm [m]; infinite in a vacuum.
[[nodiscard]] double VisibilityOf(const Medium& medium);
/// Returns Koschmieder's visibility at an altitude [m], from the extinction of molecules and
/// aerosol there and of other media.
/// @param more_per_m  extinction of other media [1/m].
[[nodiscard]] double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m);
/// Returns AirChoice::aerosol for a visibility [m] at an altitude: 0 where molecules alone already reduce it
/// further, 1000 at most.
[[nodiscard]] double AerosolForVisibility(const Medium& medium, double visibility_m,
                                          double altitude_m = 0.0);
/// Returns the ozone of the column in Dobson units, from the band that absorbs most; 0 without
/// ozone.
[[nodiscard]] double OzoneDobson(const Medium& medium);

}  // namespace alpenglow::atmosphere
