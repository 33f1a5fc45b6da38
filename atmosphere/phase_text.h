// SPDX-License-Identifier: MIT
// The shared text phase.glsl, read as C++: alpenglow::shared::PhaseHenyeyGreenstein(0.3, 0.8) in
// double, (0.3f, 0.8f) as the graphics card computes it.
#pragma once

#include "atmosphere/shared_math.h"

namespace alpenglow::shared {

#include "atmosphere/shared_begin.h"
//
#include "atmosphere/phase.glsl"
//
#include "atmosphere/shared_end.h"

}  // namespace alpenglow::shared
