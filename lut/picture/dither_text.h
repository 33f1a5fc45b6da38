// SPDX-License-Identifier: MIT
// C++ reading of dither.glsl.
#pragma once

#include <cstdint>

#include "atmosphere/dialect/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "lut/picture/dither.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
