// SPDX-License-Identifier: MIT
#include "viewer/gl/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/embedded_text.h"
#include "lut/embedded_text.h"
#include "renderer/embedded_text.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

constexpr std::size_t kLinesOfAPiece = 100000;  // more lines than any piece has

std::string LogOfShader(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader, length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

std::string LogOfProgram(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program, length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

// Removes `prefix` from the text if it starts with it, and returns whether it does.
bool Take(std::string_view& text, std::string_view prefix) {
  if (text.substr(0, prefix.size()) != prefix) return false;
  text.remove_prefix(prefix.size());
  return true;
}

// Removes a leading number from the text and returns it; nullopt if there is none.
std::optional<std::size_t> TakeNumber(std::string_view& text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

// Returns a line of a driver's log, with a position at its start replaced by name and line of our
// file.
std::string NamedLine(std::string_view line, std::span<const ShaderPiece> pieces) {
  std::string_view rest = line;
  std::string_view kind;
  for (const std::string_view word : {"ERROR: ", "WARNING: "}) {
    if (Take(rest, word)) kind = word;
  }
  const bool has_place = Take(rest, "0:") || Take(rest, "0(");
  const std::optional<std::size_t> place = has_place ? TakeNumber(rest) : std::nullopt;
  if (!place || *place / kLinesOfAPiece >= pieces.size()) return std::string(line);
  Take(rest, ")");
  std::string_view column = rest;  // column number such as "(5)", which is omitted
  if (Take(column, "(") && TakeNumber(column) && Take(column, ")")) rest = column;
  return fmt::format("{}{}:{}{}", kind, pieces[*place / kLinesOfAPiece].name,
                     *place % kLinesOfAPiece, rest);
}

/// A compiled shader stage. OpenGL keeps it alive while it is attached to a program.
class Stage {
 public:
  Stage(GLenum kind, const std::vector<ShaderPiece>& pieces) : id_(glCreateShader(kind)) {
    const std::string text = ComposeShader(pieces);
    const char* source = text.c_str();
    glShaderSource(id_, 1, &source, nullptr);
    glCompileShader(id_);
    GLint compiled = GL_FALSE;
    glGetShaderiv(id_, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return;
    const std::string log = NamePieces(LogOfShader(id_), pieces);
    glDeleteShader(id_);
    throw InternalError(fmt::format("a shader did not compile:\n{}", log));
  }
  ~Stage() { glDeleteShader(id_); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  [[nodiscard]] GLuint id() const { return id_; }

 private:
  GLuint id_;
};

}  // namespace

std::vector<ShaderPiece> SharedTexts() {
  std::vector<ShaderPiece> pieces;
  for (const char* name :
       {"atmosphere/shared_glsl/shared_prelude.glsl", "atmosphere/ray/shell.glsl",
        "atmosphere/ray/optical_depth.glsl", "atmosphere/refraction/land_lift.glsl",
        "atmosphere/ray/ray_map.glsl", "atmosphere/medium/phase.glsl",
        "atmosphere/lamp/lamp_ray.glsl", "atmosphere/astronomy/disk_light.glsl"}) {
    pieces.push_back({name, std::string(atmosphere::EmbeddedText(name))});
  }
  for (const char* name : {"lut/tables/table_maps.glsl", "lut/image/tone_curve.glsl"}) {
    pieces.push_back({name, std::string(lut::EmbeddedText(name))});
  }
  for (const char* name :
       {"renderer/procedural_mountains/lattice_noise.glsl", "renderer/material/ground_cover.glsl",
        "renderer/material/reflectance.glsl", "renderer/media/exponential_layer.glsl",
        "renderer/terrain/land_chord.glsl"}) {
    pieces.push_back({name, std::string(renderer::EmbeddedText(name))});
  }
  return pieces;
}

std::string ComposeShader(std::span<const ShaderPiece> pieces) {
  std::string text = "#version 330 core\n";
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    text += fmt::format("#line {}\n{}\n", i * kLinesOfAPiece + 1, pieces[i].text);
  }
  return text;
}

std::string NamePieces(std::string_view log, std::span<const ShaderPiece> pieces) {
  std::string named;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size() - 1) + 1;
    named += NamedLine(log.substr(0, end), pieces);
    log.remove_prefix(end);
  }
  return named;
}

ShaderProgram::ShaderProgram(const std::vector<ShaderPiece>& vertex,
                             const std::vector<ShaderPiece>& fragment,
                             const std::vector<VertexAttribute>& attributes) {
  Attach(GL_VERTEX_SHADER, vertex);
  Attach(GL_FRAGMENT_SHADER, fragment);
  for (const VertexAttribute& attribute : attributes) {
    glBindAttribLocation(program_.id(), attribute.location, attribute.name);
  }
  Link();
}

ShaderProgram ShaderProgram::ForTransformFeedback(const std::vector<ShaderPiece>& vertex,
                                                  const std::vector<std::string>& outputs) {
  ShaderProgram made;
  made.Attach(GL_VERTEX_SHADER, vertex);
  std::vector<const char*> names;
  for (const std::string& output : outputs) names.push_back(output.c_str());
  glTransformFeedbackVaryings(made.program_.id(), static_cast<GLsizei>(names.size()), names.data(),
                              GL_INTERLEAVED_ATTRIBS);
  made.Link();
  return made;
}

void ShaderProgram::Attach(GLenum kind, const std::vector<ShaderPiece>& pieces) {
  const Stage stage(kind, pieces);
  glAttachShader(program_.id(), stage.id());
}

void ShaderProgram::Link() {
  glLinkProgram(program_.id());
  GLint linked = GL_FALSE;
  glGetProgramiv(program_.id(), GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    throw InternalError(fmt::format("shaders did not link:\n{}", LogOfProgram(program_.id())));
  }
  FindUniforms();
}

// Members of blocks have no location. The name of an array ends with "[0]".
void ShaderProgram::FindUniforms() {
  GLint count = 0, longest = 0;
  glGetProgramiv(program_.id(), GL_ACTIVE_UNIFORMS, &count);
  glGetProgramiv(program_.id(), GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::string name(static_cast<std::size_t>(longest), '\0');
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLsizei length = 0;
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(program_.id(), i, longest, &length, &size, &type, name.data());
    const std::string found(name, 0, static_cast<std::size_t>(length));
    uniforms_[found.substr(0, found.find("[0]"))] =
        glGetUniformLocation(program_.id(), found.c_str());
  }
}

GLint ShaderProgram::Uniform(const char* name) const {
  const auto found = uniforms_.find(name);
  return found != uniforms_.end() ? found->second : -1;
}

void ShaderProgram::BindBlock(const char* block, GLuint binding) const {
  const GLuint index = glGetUniformBlockIndex(program_.id(), block);
  if (index != GL_INVALID_INDEX) glUniformBlockBinding(program_.id(), index, binding);
}

void ShaderProgram::BindSampler(const char* sampler, int unit) const {
  Use();
  glUniform1i(Uniform(sampler), unit);
}

}  // namespace alpenglow::viewer
