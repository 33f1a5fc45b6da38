// SPDX-License-Identifier: MIT
// Passes over a whole picture or over boxes of it with one fragment stage, and embedded
// shader texts, named by their path in the tree: "viewer/shaders/hud.frag.glsl".
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

/// Returns a text that the library of its layer embeds.
[[nodiscard]] ShaderPiece ViewerPiece(const std::string& name);

/// Returns the texts followed by those of these names.
[[nodiscard]] std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                                        const std::vector<std::string>& names);

/// Returns a program of full_screen.vert.glsl and a fragment stage of these texts.
[[nodiscard]] ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment);

/// Draws over the whole viewport of the bound target.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices);

/// The pixels that a pass fills: all, or those of some boxes. Thousands of boxes take one draw
/// call.
class PassArea {
 public:
  /// Restricts the pass to boxes.
  /// @param width, height  of the viewport.
  void Set(std::span<const PixelBox> boxes, int width, int height);

  void Draw(const ShaderProgram& program) const;

 private:
  std::optional<int> boxes_;  // number of boxes; empty: all pixels
  GlBuffer squares_;
  GlVertexArray layout_, no_vertices_;
};

}  // namespace alpenglow::viewer
