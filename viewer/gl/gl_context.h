// SPDX-License-Identifier: MIT
// Provides OpenGL core contexts, 3.3 or later, with the newest version that the driver supports;
// versions are tried downwards from 4.6.
//
// This file provides the headless context (EGL, no display); window.h provides the context of a
// window. All GL calls of this folder use the context that is current on the calling thread.
//
// It also provides owners of OpenGL object names, the upload of textures and uniform blocks and
// their binding, and a scissor rectangle and blending for a scope. An object must not outlive the
// context in which it was created.
#pragma once

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

namespace alpenglow::viewer {

/// A version of OpenGL that is requested from a driver.
struct GlVersion {
  int major;
  int minor;
};

/// Versions to request, newest first. The last one is the oldest that the shaders support. Mesa's
/// llvmpipe supports 4.5 and rejects 4.6, so one rejection does not mean that OpenGL is missing.
inline constexpr std::array<GlVersion, 8> kGlVersions{
    {{4, 6}, {4, 5}, {4, 4}, {4, 3}, {4, 2}, {4, 1}, {4, 0}, {3, 3}}};

/// A context without a display: on a GPU that EGL can reach, otherwise on Mesa's software renderer.
/// It is current on the thread that constructs it until it is destroyed.
class HeadlessContext {
 public:
  /// Throws DisplayError that lists the attempts if EGL is missing or does not support OpenGL 3.3.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns a description of the current context: "OpenGL 4.5 (Core Profile) Mesa 22.3.6 on llvmpipe
/// (...)".
[[nodiscard]] std::string GlDescription();

/// Returns whether the current context draws without a GPU.
[[nodiscard]] bool IsSoftwareOpenGl();

/// Returns the number of textures that one stage of a program may read: at least 16. The environment
/// variable ALPENGLOW_TEXTURE_UNITS lowers it, to see what other drivers draw. Throws InputError if
/// that is not a whole number from 1.
[[nodiscard]] int TextureUnitsOfDriver();

/// Throws DisplayError if the context is lost because the GPU or its driver was reset. Detection
/// requires a context that reports resets (OpenGL 4.5 or KHR_robustness).
void RequireContext();

/// Throws an error if GL has recorded one since the last call: DisplayError for insufficient memory
/// or a lost context, otherwise InternalError that names `where`.
void CheckGl(const char* where);

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

/// Sets the filter of a bound texture to linear or nearest, and clamps it at its edges.
void ClampAndFilter(GLenum target, bool linear);

/// Values of a texture: their format on the GPU, their number, and their format in memory.
struct Texels {
  GLenum internal_format;
  int width, height, depth;  // depth of a three-dimensional texture, or the number of layers
  GLenum format, type;
  const void* data;  // null: the values are undefined
};

/// Replaces the values of a texture, which is bound to the active unit; its storage is kept if size
/// and format stay the same. Between the texels it is interpolated, and it is clamped at its edges
/// except along depth.
void UploadTexture(GLenum target, const GlTexture& texture, const Texels& texels);

/// Uploads a uniform block, a struct of vec4, and binds it.
template <typename Block>
void UploadBlock(const GlBuffer& buffer, GLuint binding, const Block& block) {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
}

/// A rectangle of pixels; (x, y) is its lower left pixel.
struct PixelBox {
  int x, y, width, height;
};

[[nodiscard]] inline bool Overlap(const PixelBox& a, const PixelBox& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Returns the smallest box that contains both.
[[nodiscard]] inline PixelBox Around(const PixelBox& a, const PixelBox& b) {
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x,
          std::max(a.y + a.height, b.y + b.height) - y};
}

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

/// Blends the following draw calls with the target during its lifetime, with a share of what is drawn.
class Blending {
 public:
  enum class Kind {
    kAdd,  // share * drawn + target
    kMix,  // share * drawn + (1 - share) * target
  };
  Blending(Kind kind, double share) {
    const auto weight = static_cast<float>(share);
    glBlendColor(weight, weight, weight, weight);
    glBlendFunc(GL_CONSTANT_ALPHA, kind == Kind::kAdd ? GL_ONE : GL_ONE_MINUS_CONSTANT_ALPHA);
    glEnable(GL_BLEND);
  }
  ~Blending() { glDisable(GL_BLEND); }
  Blending(const Blending&) = delete;
  Blending& operator=(const Blending&) = delete;
};

}  // namespace alpenglow::viewer
