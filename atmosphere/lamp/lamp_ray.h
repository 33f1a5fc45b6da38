// SPDX-License-Identifier: MIT
// C++ reading of lamp_ray.glsl: what an eye has of a lamp.
#pragma once

#include "atmosphere/dialect/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "atmosphere/lamp/lamp_ray.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
