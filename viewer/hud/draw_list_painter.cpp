// SPDX-License-Identifier: MIT
#include "viewer/hud/draw_list_painter.h"

#include <algorithm>
#include <cstddef>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

constexpr GLuint kPlace = 0, kAtlasPlace = 1, kColour = 2;
constexpr int kAtlasUnit = 0;

const void* Offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

// Bytes that are drawn once.
template <typename Element>
void Upload(GLenum target, const GlBuffer& buffer, const ImVector<Element>& elements) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, static_cast<GLsizeiptr>(elements.size_in_bytes()), elements.Data,
               GL_STREAM_DRAW);
}

// A rectangle from the upper left corner, for OpenGL, which counts from the lower left one. False
// where nothing of it is in the picture.
bool Clip(const ImVec4& rectangle, const ImVec2& size) {
  const int left = std::max(static_cast<int>(rectangle.x), 0);
  const int top = std::max(static_cast<int>(rectangle.y), 0);
  const int right = std::min(static_cast<int>(rectangle.z), static_cast<int>(size.x));
  const int bottom = std::min(static_cast<int>(rectangle.w), static_cast<int>(size.y));
  if (right <= left || bottom <= top) return false;
  glScissor(left, static_cast<int>(size.y) - bottom, right - left, bottom - top);
  return true;
}

}  // namespace

DrawListPainter::DrawListPainter()
    : program_({ViewerPiece("viewer/shaders/hud.vert.glsl")},
               {ViewerPiece("viewer/shaders/hud.frag.glsl")},
               {{kPlace, "place"}, {kAtlasPlace, "atlas_place"}, {kColour, "colour"}}) {
  program_.BindSampler("atlas", kAtlasUnit);
  glBindVertexArray(layout_.id());
  glBindBuffer(GL_ARRAY_BUFFER, corners_.id());
  constexpr GLsizei kStride = sizeof(ImDrawVert);
  glVertexAttribPointer(kPlace, 2, GL_FLOAT, GL_FALSE, kStride, Offset(offsetof(ImDrawVert, pos)));
  glVertexAttribPointer(kAtlasPlace, 2, GL_FLOAT, GL_FALSE, kStride,
                        Offset(offsetof(ImDrawVert, uv)));
  glVertexAttribPointer(kColour, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                        Offset(offsetof(ImDrawVert, col)));
  for (const GLuint attribute : {kPlace, kAtlasPlace, kColour})
    glEnableVertexAttribArray(attribute);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, order_.id());
  glBindVertexArray(0);
}

void DrawListPainter::UploadAtlas(ImFontAtlas& atlas) {
  unsigned char* coverage = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsAlpha8(&coverage, &width, &height);
  glActiveTexture(GL_TEXTURE0 + kAtlasUnit);
  glBindTexture(GL_TEXTURE_2D, atlas_.id());
  ClampAndFilter(GL_TEXTURE_2D, true);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, coverage);
}

void DrawListPainter::Paint(const ImDrawData& data, GLuint framebuffer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, static_cast<GLsizei>(data.DisplaySize.x),
             static_cast<GLsizei>(data.DisplaySize.y));
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glEnable(GL_SCISSOR_TEST);
  program_.Use();
  glUniform2f(program_.Uniform("picture_size"), data.DisplaySize.x, data.DisplaySize.y);
  glActiveTexture(GL_TEXTURE0 + kAtlasUnit);
  glBindTexture(GL_TEXTURE_2D, atlas_.id());
  glBindVertexArray(layout_.id());
  for (int i = 0; i < data.CmdListsCount; ++i) PaintList(*data.CmdLists[i], data);
  glBindVertexArray(0);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  CheckGl("instruments and panels");
}

void DrawListPainter::PaintList(const ImDrawList& list, const ImDrawData& data) const {
  Upload(GL_ARRAY_BUFFER, corners_, list.VtxBuffer);
  Upload(GL_ELEMENT_ARRAY_BUFFER, order_, list.IdxBuffer);
  constexpr GLenum kIndex = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.ElemCount == 0 || !Clip(command.ClipRect, data.DisplaySize)) continue;
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), kIndex,
                             Offset(command.IdxOffset * sizeof(ImDrawIdx)),
                             static_cast<GLint>(command.VtxOffset));
  }
}

}  // namespace alpenglow::viewer
