// SPDX-License-Identifier: MIT
// The shared source phase.glsl, compiled as C++: alpenglow::shared::PhaseHenyeyGreenstein(0.3, 0.8)
// in double, and (0.3f, 0.8f) as the GPU computes it.
#pragma once

#include "atmosphere/shared_glsl/shared_math.h"

namespace alpenglow::shared {

#include "atmosphere/shared_glsl/shared_begin.h"
//
#include "atmosphere/medium/phase.glsl"
//
#include "atmosphere/shared_glsl/shared_end.h"

}  // namespace alpenglow::shared
