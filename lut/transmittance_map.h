// SPDX-License-Identifier: MIT
// C++ reading of transmittance_map.glsl: templates over double, float and SIMD batches. Lengths are
// kilometres here; TransmittanceTable takes metres.
#pragma once

#include "atmosphere/shell.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_begin.h"
#include "lut/transmittance_map.glsl"
#include "atmosphere/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
