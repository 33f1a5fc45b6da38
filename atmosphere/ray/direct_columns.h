// SPDX-License-Identifier: MIT
// Compiles direct_columns.glsl as C++: columns with one division, and the map of a panel.
#pragma once

#include "atmosphere/ray/shell.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/ray/direct_columns.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared
