// SPDX-License-Identifier: MIT
// Compiles the shared texts of this folder as C++: templates over double, float and SIMD batches.
// shell.glsl and optical_depth.glsl hold the geometry of the shell and columns of air; ray_map.glsl
// the panels of a ray and the planet's shadow on it.
// Lengths are kilometres here; the classes based on them (single_scattering.h) take metres.
#pragma once

#include "atmosphere/shared_glsl/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/ray/shell.glsl"
#include "atmosphere/ray/optical_depth.glsl"
#include "atmosphere/ray/ray_map.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
