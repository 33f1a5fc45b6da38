// SPDX-License-Identifier: MIT
// Shaders composed of pieces: version line, prelude, shared texts, stage.
//
// GLSL has no #include. Every piece starts with `#line 100000 N + 1`, N counting the pieces, and
// such a line in the driver's log is turned back into our file and line, so a message reads
// "atmosphere/ray/shell.glsl:12: ...". (The second number that #line may have, the source string,
// is no use: Mesa 22 forgets it in most messages.)
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/gl/gl_objects.h"

namespace alpenglow::viewer {

/// A text that becomes part of a shader, and the name it has in messages.
struct ShaderPiece {
  std::string name;
  std::string text;
};

/// The texts that C++ reads too, in the order of their dependencies, opened by shared_prelude.glsl.
[[nodiscard]] std::vector<ShaderPiece> SharedTexts();

/// A stage for glShaderSource: `#version 330 core`, then the pieces.
[[nodiscard]] std::string ComposeShader(std::span<const ShaderPiece> pieces);

/// A driver's log with the lines of pieces turned into names and lines of files. Understands the
/// forms "0:300012(5): ..." (Mesa), "0(300012) : ..." (NVIDIA) and "ERROR: 0:300012: ..." (others).
[[nodiscard]] std::string NamePieces(std::string_view log, std::span<const ShaderPiece> pieces);

/// A vertex attribute and where it is bound.
struct VertexAttribute {
  GLuint location;
  const char* name;
};

/// A linked program.
class ShaderProgram {
 public:
  /// Throws InternalError with the driver's log when a stage does not compile or link.
  ShaderProgram(const std::vector<ShaderPiece>& vertex, const std::vector<ShaderPiece>& fragment,
                const std::vector<VertexAttribute>& attributes = {});

  /// A program that only turns vertices into values, recorded by transform feedback: the outputs
  /// named, interleaved. No fragment stage.
  static ShaderProgram ForTransformFeedback(const std::vector<ShaderPiece>& vertex,
                                            const std::vector<std::string>& outputs);

  void Use() const { glUseProgram(program_.id()); }
  [[nodiscard]] GLuint id() const { return program_.id(); }

  /// Location of a uniform; -1, which the glUniform calls ignore, when the stage does not read it.
  [[nodiscard]] GLint Uniform(const char* name) const;
  /// Ties the uniform block to a binding point; a block that no stage reads is passed over.
  void BindBlock(const char* block, GLuint binding) const;
  /// Makes the sampler read from a texture unit.
  void BindSampler(const char* sampler, int unit) const;

 private:
  ShaderProgram() = default;
  void Attach(GLenum kind, const std::vector<ShaderPiece>& pieces);
  void Link();

  GlProgram program_;
};

}  // namespace alpenglow::viewer
