// SPDX-License-Identifier: MIT
// Provides owners of OpenGL object names, and a scissor rectangle for its scope. An object must not outlive the context in which it was created.
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

struct Buffer {
  static GLuint Make() {
    GLuint id = 0;
    glGenBuffers(1, &id);
    return id;
  }
  static void Free(GLuint id) { glDeleteBuffers(1, &id); }
};

struct VertexArray {
  static GLuint Make() {
    GLuint id = 0;
    glGenVertexArrays(1, &id);
    return id;
  }
  static void Free(GLuint id) { glDeleteVertexArrays(1, &id); }
};

struct Texture {
  static GLuint Make() {
    GLuint id = 0;
    glGenTextures(1, &id);
    return id;
  }
  static void Free(GLuint id) { glDeleteTextures(1, &id); }
};

struct Framebuffer {
  static GLuint Make() {
    GLuint id = 0;
    glGenFramebuffers(1, &id);
    return id;
  }
  static void Free(GLuint id) { glDeleteFramebuffers(1, &id); }
};

struct Query {
  static GLuint Make() {
    GLuint id = 0;
    glGenQueries(1, &id);
    return id;
  }
  static void Free(GLuint id) { glDeleteQueries(1, &id); }
};

struct Program {
  static GLuint Make() { return glCreateProgram(); }
  static void Free(GLuint id) { glDeleteProgram(id); }
};

}  // namespace gl_kind

using GlBuffer = GlObject<gl_kind::Buffer>;
using GlVertexArray = GlObject<gl_kind::VertexArray>;
using GlTexture = GlObject<gl_kind::Texture>;
using GlFramebuffer = GlObject<gl_kind::Framebuffer>;
using GlQuery = GlObject<gl_kind::Query>;
using GlProgram = GlObject<gl_kind::Program>;

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
