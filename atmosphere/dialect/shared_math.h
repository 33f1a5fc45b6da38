// SPDX-License-Identifier: MIT
// The builtins of GLSL that shared texts use, for plain numbers. SIMD batches bring their own
// overloads (xsimd), found by argument-dependent lookup.
#pragma once

#include <cmath>

namespace alpenglow::shared {

#include "atmosphere/dialect/shared_builtins.h"

}  // namespace alpenglow::shared
