// SPDX-License-Identifier: MIT
// The letters of instruments and panels, made at the size at which they are read.
//
// Colours and sizes of panels, for the Dear ImGui context that is current.
//
// Mouse and keyboard as Dear ImGui wants them told, in its versions before and since 1.87.
//
// Triangles that Dear ImGui has listed, drawn over the picture.
//
// Own code instead of imgui_impl_opengl3, which brings a second loader of OpenGL that wants
// libGL.so.1: contexts without a display have none.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <optional>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/hud/hud.h"
#include "viewer/hud/hud_model.h"

namespace alpenglow::viewer {

/// DejaVu Sans where a package has put it (Debian: fonts-dejavu-core).
[[nodiscard]] std::optional<std::filesystem::path> InstalledFont();

/// Empties the atlas and puts letters of Latin, Greek and Cyrillic into it: those of `font`, or
/// without one those that Dear ImGui brings (Latin only, in whole multiples of 13 pixels). Throws
/// InputError when the file is no TrueType font.
/// @param scale  pixels a unit; letters are 14 units high.
void LoadFont(ImFontAtlas& atlas, double scale, const std::optional<std::filesystem::path>& font);

/// @param scale  pixels a unit.
void ApplyStyle(HudTheme theme, double scale);

/// Before each NewFrame.
void TellInput(ImGuiIO& io, const HudInput& input);

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
