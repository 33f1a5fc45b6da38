// SPDX-License-Identifier: MIT
// The viewer's own texts for shaders, by their names in the tree: "viewer/shaders/hud.frag.glsl".
#pragma once

#include <string>
#include <vector>

#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

[[nodiscard]] ShaderPiece ViewerPiece(const std::string& name);

/// These texts, and after them the viewer's of these names.
[[nodiscard]] std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                                        const std::vector<std::string>& names);

}  // namespace alpenglow::viewer
