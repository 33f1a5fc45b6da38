// SPDX-License-Identifier: MIT
// The solar spectrum as published, for integrals that must resolve its lines.
#pragma once

#include "atmosphere/colour/spectrum.h"

namespace alpenglow::atmosphere {

/// ASTM G173-03, extraterrestrial [W m^-2 nm^-1], 300 to 900 nm in steps of 0.5 and 1 nm.
[[nodiscard]] const SampledFunction& SolarTable();

}  // namespace alpenglow::atmosphere
