// SPDX-License-Identifier: MIT
// C++ reading of scattering_map.glsl: templates over double, float and SIMD batches. Lengths are
// kilometres here; ScatteringTable takes metres.
#pragma once

#include "lut/table/transmittance_map.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "lut/table/scattering_map.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
