// SPDX-License-Identifier: MIT
// The shared text disk_light.glsl, read as C++.
#pragma once

#include "atmosphere/dialect/shared_math.h"

namespace alpenglow::shared {

#include "atmosphere/dialect/shared_begin.h"
//
#include "atmosphere/sun/disk_light.glsl"
//
#include "atmosphere/dialect/shared_end.h"

}  // namespace alpenglow::shared
