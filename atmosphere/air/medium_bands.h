// SPDX-License-Identifier: MIT
// A medium on other wavelengths than those it was given on.
#pragma once

#include <optional>

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere {

/// The medium on WavelengthSet(bands): the preset that it was made from (Medium::name) there, times
/// what the medium differs from that preset by, linear between its wavelengths. Exact for a preset,
/// and where the differences are factors of all wavelengths (ozone in Dobson units, visibility).
/// Nothing where the preset is not known, has no values there, or has none of what the medium has.
[[nodiscard]] std::optional<Medium> OnBands(const Medium& medium, int bands);

}  // namespace alpenglow::atmosphere
