// SPDX-License-Identifier: MIT
// C++ reading of scattering_map.glsl: templates over double, float and SIMD batches. Lengths are
// kilometres here; ScatteringTable takes metres.
#pragma once

#include "lut/transmittance_map.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_begin.h"
#include "lut/scattering_map.glsl"
#include "atmosphere/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
