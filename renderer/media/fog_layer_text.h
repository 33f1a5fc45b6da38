// SPDX-License-Identifier: MIT
// C++ reading of fog_layer.glsl: densities and columns of height fog.
#pragma once

#include "atmosphere/lamp/lamp_ray.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/media/fog_layer.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
