// SPDX-License-Identifier: MIT
#include "viewer/shaders/viewer_texts.h"

#include "viewer/embedded_text.h"

namespace alpenglow::viewer {

ShaderPiece ViewerPiece(const std::string& name) {
  return {name, std::string(viewer::EmbeddedText(name))};
}

std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                          const std::vector<std::string>& names) {
  for (const std::string& name : names) texts.push_back(ViewerPiece(name));
  return texts;
}

}  // namespace alpenglow::viewer
