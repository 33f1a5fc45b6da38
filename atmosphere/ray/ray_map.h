// SPDX-License-Identifier: MIT
// Compiles ray_map.glsl as C++: the panels of a ray and the planet's shadow on it.
#pragma once

#include "atmosphere/ray/shell.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/ray/ray_map.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
