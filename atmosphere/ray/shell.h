// SPDX-License-Identifier: MIT
// Compiles shell.glsl and optical_depth.glsl as C++: templates over double, float and SIMD batches.
// Lengths are kilometres here; the classes based on them (single_scattering.h) take metres.
#pragma once

#include "atmosphere/shared_glsl/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/ray/shell.glsl"
#include "atmosphere/ray/optical_depth.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
