// SPDX-License-Identifier: MIT
// Triangles that Dear ImGui has listed, drawn over the picture.
//
// Own code instead of imgui_impl_opengl3, which brings a second loader of OpenGL that wants
// libGL.so.1: contexts without a display have none.
#pragma once

#include <imgui.h>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

class DrawListPainter {
 public:
  /// An OpenGL context must be current, now and in all calls.
  DrawListPainter();

  /// Letters and lines of the atlas go to the graphics card, in place of those before.
  void UploadAtlas(ImFontAtlas& atlas);

  /// Blends the lists over what the framebuffer (0: the window) holds, in the order they have. No
  /// depth test, blending or scissor test is left on, and no vertex array bound.
  void Paint(const ImDrawData& data, GLuint framebuffer) const;

 private:
  void PaintList(const ImDrawList& list, const ImDrawData& data) const;

  ShaderProgram program_;
  GlTexture atlas_;
  GlVertexArray layout_;
  GlBuffer corners_, order_;
};

}  // namespace alpenglow::viewer
