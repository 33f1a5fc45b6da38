// SPDX-License-Identifier: MIT
// C++ reading of ground_cover.glsl: materials of the ground by altitude and slope.
#pragma once

#include <cstdint>

#include "atmosphere/dialect/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/ground/ground_cover.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
