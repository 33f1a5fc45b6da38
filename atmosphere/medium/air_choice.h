// SPDX-License-Identifier: MIT
// Provides AirChoice, the changes of a medium by a user (aerosol, ozone, ground), and the visibility
// and ozone of a medium.
#pragma once

#include <optional>

#include "atmosphere/medium/medium.h"

namespace alpenglow::atmosphere {

/// Changes of a medium; unset values keep those of the medium.
struct AirChoice {
  double aerosol = 1.0;                 // factor on the aerosol of the medium, [0, 1000]
  std::optional<double> ozone_du;       // of the whole column, [0, 10000]
  std::optional<double> ground_albedo;  // [0, 1], in all bands
};

/// Returns the changed medium. Throws InputError that names the value out of range.
[[nodiscard]] Medium Changed(Medium medium, const AirChoice& choice);

/// Returns Koschmieder's visibility at altitude 0 in the band nearest to 550 nm [m]; infinite in a
/// vacuum.
[[nodiscard]] double VisibilityOf(const Medium& medium);
/// Returns Koschmieder's visibility at an altitude [m], from the extinction of molecules and
/// aerosol there and of fog.
/// @param more_per_m  extinction of fog [1/m].
[[nodiscard]] double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m);
/// Returns AirChoice::aerosol for a visibility [m]: 0 where molecules alone already reduce it
/// further, 1000 at most.
[[nodiscard]] double AerosolForVisibility(const Medium& medium, double visibility_m);
/// Returns the ozone of the column in Dobson units, from the band that absorbs most; 0 without
/// ozone.
[[nodiscard]] double OzoneDobson(const Medium& medium);

}  // namespace alpenglow::atmosphere
