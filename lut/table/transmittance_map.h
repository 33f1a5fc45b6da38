// SPDX-License-Identifier: MIT
// C++ reading of transmittance_map.glsl: templates over double, float and SIMD batches. Lengths are
// kilometres here; TransmittanceTable takes metres.
#pragma once

#include "atmosphere/ray/shell.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "lut/table/transmittance_map.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
