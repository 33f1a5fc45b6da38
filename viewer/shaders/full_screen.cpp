// SPDX-License-Identifier: MIT
#include "viewer/shaders/full_screen.h"

#include "viewer/shaders/viewer_texts.h"

namespace alpenglow {

ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment) {
  return ShaderProgram({ViewerPiece("viewer/shaders/full_screen.vert.glsl")}, fragment);
}

void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices) {
  program.Use();
  glBindVertexArray(no_vertices.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace alpenglow
