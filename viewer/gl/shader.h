// SPDX-License-Identifier: MIT
// Provides shader programs that are composed of pieces: version line, prelude, shared texts, stage.
//
// GLSL has no #include. Every piece starts with `#line 100000 N + 1`, where N is the index of the
// piece. Line numbers of the driver's log are converted back to file and line, so a message reads
// "atmosphere/ray/shell.glsl:12: ...". (The optional second number of #line, the source string, is
// not usable: Mesa 22 omits it in most messages.)
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/gl/gl_context.h"

namespace alpenglow::viewer {

/// A part of a shader's text, and its name in messages.
struct ShaderPiece {
  std::string name;
  std::string text;
};

/// Returns the texts that are shared with C++, in the order of their dependencies;
/// shared_prelude.glsl is the first.
[[nodiscard]] std::vector<ShaderPiece> SharedTexts();

/// Returns the text of a stage for glShaderSource: `#version 330 core`, then the pieces.
[[nodiscard]] std::string ComposeShader(std::span<const ShaderPiece> pieces);

/// Returns a driver's log with the line numbers of pieces replaced by file names and lines.
/// Supports the forms "0:300012(5): ..." (Mesa), "0(300012) : ..." (NVIDIA) and "ERROR: 0:300012:
/// ..." (others).
[[nodiscard]] std::string NamePieces(std::string_view log, std::span<const ShaderPiece> pieces);

/// A vertex attribute and its location.
struct VertexAttribute {
  GLuint location;
  const char* name;
};

/// A linked program.
class ShaderProgram {
 public:
  /// Throws InternalError with the driver's log if a stage does not compile or link.
  ShaderProgram(const std::vector<ShaderPiece>& vertex, const std::vector<ShaderPiece>& fragment,
                const std::vector<VertexAttribute>& attributes = {});

  /// Creates a program without a fragment stage that converts vertices to values. Transform
  /// feedback records the named outputs, interleaved.
  static ShaderProgram ForTransformFeedback(const std::vector<ShaderPiece>& vertex,
                                            const std::vector<std::string>& outputs);

  void Use() const { glUseProgram(program_.id()); }
  [[nodiscard]] GLuint id() const { return program_.id(); }

  /// Returns the location of a uniform; -1, which glUniform calls ignore, if the program does not
  /// use it.
  [[nodiscard]] GLint Uniform(const char* name) const;
  /// Assigns the uniform block to a binding point; a block that no stage uses is ignored.
  void BindBlock(const char* block, GLuint binding) const;
  /// Assigns the sampler to a texture unit.
  void BindSampler(const char* sampler, int unit) const;

 private:
  ShaderProgram() = default;
  void Attach(GLenum kind, const std::vector<ShaderPiece>& pieces);
  void Link();
  void FindUniforms();

  GlProgram program_;
  std::map<std::string, GLint, std::less<>> uniforms_;  // locations by name
};

}  // namespace alpenglow::viewer
