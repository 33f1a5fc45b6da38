// SPDX-License-Identifier: MIT
// The viewer's own texts for shaders, by their names in the tree: "viewer/shaders/hud.frag.glsl".
//
// Passes over a whole picture, or over boxes of it: one fragment stage.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

[[nodiscard]] ShaderPiece ViewerPiece(const std::string& name);

/// These texts, and after them the viewer's of these names.
[[nodiscard]] std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                                        const std::vector<std::string>& names);

/// full_screen.vert.glsl and a fragment stage of these texts.
[[nodiscard]] ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment);

/// Draws into what is bound, over the whole viewport.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices);

/// Which pixels a pass fills: all, or those of some boxes. Thousands of boxes are one draw.
class PassArea {
 public:
  /// @param width, height  of the viewport that is drawn into.
  void Set(std::span<const PixelBox> boxes, int width, int height);

  void Draw(const ShaderProgram& program) const;

 private:
  std::optional<int> boxes_;  // nothing: all
  GlBuffer squares_;
  GlVertexArray layout_, no_vertices_;
};

}  // namespace alpenglow::viewer
