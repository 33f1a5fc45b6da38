// SPDX-License-Identifier: MIT
// Passes over a whole picture: one triangle, one fragment stage.
#pragma once

#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow {

/// full_screen.vert.glsl and a fragment stage of these texts.
[[nodiscard]] ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment);

/// Draws into what is bound, over the whole viewport.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices);

}  // namespace alpenglow
