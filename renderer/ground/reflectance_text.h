// SPDX-License-Identifier: MIT
// C++ reading of reflectance.glsl.
#pragma once

#include "atmosphere/dialect/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/ground/reflectance.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
