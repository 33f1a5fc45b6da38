// SPDX-License-Identifier: MIT
// C++ reading of lattice_noise.glsl.
#pragma once

#include <cstdint>

#include "atmosphere/dialect/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/terrain/lattice_noise.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
