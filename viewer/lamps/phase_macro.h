// SPDX-License-Identifier: MIT
// Phase functions as shaders that are made for one kind call them.
#pragma once

#include <glm/vec4.hpp>
#include <string>

#include "atmosphere/air/phase.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// An expression over a cosine `c` and a vector `p` of parameters, ParametersOf(). Tables have
/// none: what reads them has a texture.
[[nodiscard]] std::string PhaseExpression(PhaseKind kind);
[[nodiscard]] glm::vec4 ParametersOf(const PhaseFunction& phase);

}  // namespace alpenglow::viewer
