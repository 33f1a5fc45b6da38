// SPDX-License-Identifier: MIT
// C++ reading of shell.glsl and optical_depth.glsl: templates over double, float and SIMD batches.
// Lengths are kilometres here; the classes above (single_scattering.h) take metres.
#pragma once

#include "atmosphere/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_begin.h"
#include "atmosphere/shell.glsl"
#include "atmosphere/optical_depth.glsl"
#include "atmosphere/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
