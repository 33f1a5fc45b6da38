// SPDX-License-Identifier: MIT
// Passes over the whole picture: one triangle, one fragment stage.
#pragma once

#include <string>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow {

/// A text of viewer/shaders by its name in the tree.
[[nodiscard]] ShaderPiece ViewerPiece(const std::string& name);

/// full_screen.vert.glsl and a fragment stage after its texts.
[[nodiscard]] ShaderProgram FullScreenProgram(std::vector<ShaderPiece> texts,
                                              const std::string& stage);

/// Draws into what is bound, over the whole viewport.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices);

}  // namespace alpenglow
