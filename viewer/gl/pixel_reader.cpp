// SPDX-License-Identifier: MIT
#include "viewer/gl/pixel_reader.h"

#include <utility>

#include "viewer/gl/gl_context.h"

namespace alpenglow::viewer {
namespace {

GLsizeiptr BytesOf(std::size_t pixels) {
  return static_cast<GLsizeiptr>(pixels * sizeof(std::array<float, 3>));
}

}  // namespace

PixelReader::~PixelReader() { Forget(); }

void PixelReader::Forget() {
  if (arrives_ != nullptr) glDeleteSync(std::exchange(arrives_, nullptr));
}

void PixelReader::Begin(const RenderTarget& picture, const Rectangle& part) {
  if (Busy()) return;
  pixels_ = static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.id());
  glBufferData(GL_PIXEL_PACK_BUFFER, BytesOf(pixels_), nullptr, GL_STREAM_READ);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(part.left, part.bottom, part.width, part.height, GL_RGB, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  arrives_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  CheckGl("PixelReader::Begin");
}

std::optional<std::vector<std::array<float, 3>>> PixelReader::Take() {
  if (!Busy()) return std::nullopt;
  const GLenum state = glClientWaitSync(arrives_, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) return std::nullopt;
  glDeleteSync(std::exchange(arrives_, nullptr));
  std::vector<std::array<float, 3>> rgb(pixels_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.id());
  glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, BytesOf(pixels_), rgb.data());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  return rgb;
}

}  // namespace alpenglow::viewer
