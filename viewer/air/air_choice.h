// SPDX-License-Identifier: MIT
// Air as a pilot changes it: visibility, aerosol, ozone, ground.
#pragma once

#include <optional>

#include "atmosphere/air/medium.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Changes of a medium; what is left out stays.
struct AirChoice {
  double aerosol = 1.0;                 // times as much as the medium has, [0, 1000]
  std::optional<double> ozone_du;       // of the column, [0, 10000]
  std::optional<double> ground_albedo;  // [0, 1], in all bands
};

/// Throws InputError naming what is out of range.
[[nodiscard]] Medium Changed(Medium medium, const AirChoice& choice);

/// Koschmieder's visibility at altitude 0 in the band nearest to 550 nm [m]; infinite in a vacuum.
[[nodiscard]] double VisibilityOf(const Medium& medium);
/// The same at an altitude, of molecules and aerosol there and of what else takes light.
/// @param more_per_m  extinction of fog [1/m].
[[nodiscard]] double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m);
/// AirChoice::aerosol for a visibility [m]: 0 where molecules alone leave no more, 1000 at most.
[[nodiscard]] double AerosolForVisibility(const Medium& medium, double visibility_m);
/// Of the column, in the band that absorbs most; 0 without ozone.
[[nodiscard]] double OzoneDobson(const Medium& medium);

}  // namespace alpenglow::viewer
