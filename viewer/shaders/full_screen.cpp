// SPDX-License-Identifier: MIT
#include "viewer/shaders/full_screen.h"

#include <glm/vec4.hpp>

#include "lut/embedded_text.h"
#include "renderer/embedded_text.h"
#include "viewer/embedded_text.h"

namespace alpenglow::viewer {

ShaderPiece ViewerPiece(const std::string& name) {
  if (name.starts_with("lut/")) return {name, std::string(lut::EmbeddedText(name))};
  if (name.starts_with("renderer/")) return {name, std::string(renderer::EmbeddedText(name))};
  return {name, std::string(viewer::EmbeddedText(name))};
}

std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                          const std::vector<std::string>& names) {
  for (const std::string& name : names) texts.push_back(ViewerPiece(name));
  return texts;
}

namespace {

constexpr GLuint kSquare = 0;

}  // namespace

ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment) {
  return ShaderProgram({ViewerPiece("viewer/shaders/full_screen.vert.glsl")}, fragment,
                       {{kSquare, "square"}});
}

// The attribute has no array, so its value is that of glVertexAttrib.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices) {
  program.Use();
  glBindVertexArray(no_vertices.id());
  glVertexAttrib4f(kSquare, 0.0F, 0.0F, 0.0F, 0.0F);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PassArea::Set(std::span<const PixelBox> boxes, int width, int height) {
  boxes_ = static_cast<int>(boxes.size());
  std::vector<glm::vec4> squares;
  squares.reserve(boxes.size());
  const auto place = [](int pixel, int side) {
    return 2.0F * static_cast<float>(pixel) / static_cast<float>(side) - 1.0F;
  };
  for (const PixelBox& box : boxes)
    squares.emplace_back(place(box.x, width), place(box.y, height), place(box.x + box.width, width),
                         place(box.y + box.height, height));
  glBindVertexArray(layout_.id());
  glBindBuffer(GL_ARRAY_BUFFER, squares_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(glm::vec4) * squares.size()),
               squares.data(), GL_DYNAMIC_DRAW);
  glEnableVertexAttribArray(kSquare);
  glVertexAttribPointer(kSquare, 4, GL_FLOAT, GL_FALSE, sizeof(glm::vec4), nullptr);
  glVertexAttribDivisor(kSquare, 1);
}

void PassArea::Draw(const ShaderProgram& program) const {
  if (!boxes_) return DrawFullScreen(program, no_vertices_);
  if (boxes_ == 0) return;
  program.Use();
  glBindVertexArray(layout_.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, *boxes_);
}

}  // namespace alpenglow::viewer
