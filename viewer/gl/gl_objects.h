// SPDX-License-Identifier: MIT
// Provides owners of OpenGL object names, the binding of a texture to a unit, a scissor rectangle
// for its scope, and texture sizes that are not powers of two. An object must not outlive the
// context in which it was created.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace alpenglow::viewer {

/// An object name that Kind::Make creates and Kind::Free releases. It can be moved but not copied.
template <typename Kind>
class GlObject {
 public:
  GlObject() : id_(Kind::Make()) {}
  ~GlObject() {
    if (id_ != 0) Kind::Free(id_);
  }
  GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }

  [[nodiscard]] GLuint id() const { return id_; }

 private:
  GLuint id_;
};

namespace gl_kind {

/// Objects whose names OpenGL returns in an array, by the functions glGen... and glDelete...
template <auto& kGenerate, auto& kDelete>
struct Named {
  static GLuint Make() {
    GLuint id = 0;
    kGenerate(1, &id);
    return id;
  }
  static void Free(GLuint id) { kDelete(1, &id); }
};

struct Program {
  static GLuint Make() { return glCreateProgram(); }
  static void Free(GLuint id) { glDeleteProgram(id); }
};

}  // namespace gl_kind

using GlBuffer = GlObject<gl_kind::Named<glGenBuffers, glDeleteBuffers>>;
using GlVertexArray = GlObject<gl_kind::Named<glGenVertexArrays, glDeleteVertexArrays>>;
using GlTexture = GlObject<gl_kind::Named<glGenTextures, glDeleteTextures>>;
using GlFramebuffer = GlObject<gl_kind::Named<glGenFramebuffers, glDeleteFramebuffers>>;
using GlQuery = GlObject<gl_kind::Named<glGenQueries, glDeleteQueries>>;
using GlProgram = GlObject<gl_kind::Program>;

/// Binds a texture to a unit, which becomes the active one.
inline void BindTexture(int unit, GLenum target, const GlTexture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(target, texture.id());
}

/// A rectangle of pixels; (x, y) is its lower left pixel.
struct PixelBox {
  int x, y, width, height;
};

/// Restricts draw calls to the pixels of a box during its lifetime. Scissors cannot be nested.
class Scissor {
 public:
  explicit Scissor(const PixelBox& box) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(box.x, box.y, box.width, box.height);
  }
  ~Scissor() { glDisable(GL_SCISSOR_TEST); }
  Scissor(const Scissor&) = delete;
  Scissor& operator=(const Scissor&) = delete;
};

}  // namespace alpenglow::viewer
