// SPDX-License-Identifier: MIT
#include "viewer/paint/full_screen.h"

#include "viewer/embedded_text.h"

namespace alpenglow {

ShaderPiece ViewerPiece(const std::string& name) {
  return {name, std::string(viewer::EmbeddedText(name))};
}

ShaderProgram FullScreenProgram(std::vector<ShaderPiece> texts, const std::string& stage) {
  texts.push_back(ViewerPiece(stage));
  return ShaderProgram({ViewerPiece("viewer/shaders/full_screen.vert.glsl")}, texts);
}

void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices) {
  program.Use();
  glBindVertexArray(no_vertices.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace alpenglow
