// SPDX-License-Identifier: MIT
// From the column of ozone, as weather services give it, to the coefficient at the peak of its
// layer.
//
// A medium on other wavelengths than those it was given on.
//
// An atmosphere as people name it: a preset, or a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere {

/// Absorption coefficient at the peak of the layer [1/m] when its column is
/// `column_dobson` (1 DU = 2.6867811e20 molecules per m^2): column times cross section
/// over the depth of the layer.
/// @param wavelength_nm  in [360, 830]; 0 where the cross section has no data.
[[nodiscard]] double OzoneAbsorptionAtPeak(double column_dobson, const OzoneLayer& layer,
                                           double wavelength_nm);

/// The medium on WavelengthSet(bands): the preset that it was made from (Medium::name) there, times
/// what the medium differs from that preset by, linear between its wavelengths. Exact for a preset,
/// and where the differences are factors of all wavelengths (ozone in Dobson units, visibility).
/// Nothing where the preset is not known, has no values there, or has none of what the medium has.
[[nodiscard]] std::optional<Medium> OnBands(const Medium& medium, int bands);

/// MediumPreset of a name that is one of MediumPresetNames, else ReadMedium of the file, whose name
/// is relative to `folder`. Throws InputError as they do; for a word that is neither it names the
/// nearest preset, or all.
[[nodiscard]] Medium MediumFromChoice(const std::string& preset_or_file,
                                      const std::filesystem::path& folder = {});

}  // namespace alpenglow::atmosphere
