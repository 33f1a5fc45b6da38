// SPDX-License-Identifier: MIT
// Backend of Dear ImGui: fonts, style, input and OpenGL drawing.
//
// Glyphs are rasterised at their display size. The style sets colours and sizes of panels in the
// current Dear ImGui context. Input is passed in the form that Dear ImGui expects before and since
// version 1.87. Triangle lists of Dear ImGui are drawn over the picture.
//
// This code replaces imgui_impl_opengl3, which brings a second OpenGL loader that needs libGL.so.1.
// Contexts without a display do not have that library.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/hud/hud_model.h"
#include "viewer/input/controls.h"

namespace alpenglow::viewer {

/// Returns the DejaVu Sans font of an installed package (Debian: fonts-dejavu-core), if there is
/// one.
[[nodiscard]] std::optional<std::filesystem::path> InstalledFont();

/// Empties the atlas and adds Latin, Greek and Cyrillic glyphs of `font`, or without one the
/// built-in font of Dear ImGui (Latin only, in integer multiples of 13 pixels). Throws InputError
/// if the file is not a TrueType font.
/// @param scale  pixels per unit; letters are 14 units high.
void LoadFont(ImFontAtlas& atlas, double scale, const std::optional<std::filesystem::path>& font);

/// @param scale  pixels per unit.
void ApplyStyle(HudTheme theme, double scale);

/// Keys that are held, or were pressed and released since the last frame.
class PanelKeys {
 public:
  /// Takes the keys of a frame. A window that loses the keyboard releases all keys.
  void Take(const WindowEvents& events);
  /// @param glfw_key  GLFW_KEY_...
  [[nodiscard]] bool IsDown(int glfw_key) const;

 private:
  std::vector<int> held_, pressed_;  // pressed: in this frame
};

/// Passes the input of a frame to Dear ImGui. Call before each NewFrame.
void FeedInput(ImGuiIO& io, const InputFrame& input, const PanelKeys& keys);

class DrawListPainter {
 public:
  /// An OpenGL context must be current, now and in all calls.
  DrawListPainter();

  /// Replaces the atlas texture with glyphs and lines of `atlas`.
  void UploadAtlas(ImFontAtlas& atlas);

  /// Blends the lists over the framebuffer (0: the window) in their order. Leaves depth test,
  /// blending and scissor test disabled, and no vertex array bound.
  void Paint(const ImDrawData& data, GLuint framebuffer) const;

 private:
  void PaintList(const ImDrawList& list, const ImDrawData& data) const;

  ShaderProgram program_;
  GlTexture atlas_;
  GlVertexArray layout_;
  GlBuffer corners_, order_;
};

}  // namespace alpenglow::viewer
