// SPDX-License-Identifier: MIT
// The builtins of GLSL that shared sources use, for scalars. SIMD batches have their own overloads
// (xsimd), found by argument-dependent lookup.
#pragma once

#include <cmath>

namespace alpenglow::shared {

#include "atmosphere/shared_glsl/shared_builtins.h"

}  // namespace alpenglow::shared
