// SPDX-License-Identifier: MIT
#include "viewer/gl/render_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "atmosphere/base/error.h"
#include "viewer/gl/gl_context.h"

namespace alpenglow::viewer {
namespace {

struct FormatRow {
  GLint internal;
  GLenum format, type;
};

const FormatRow& RowOf(PixelFormat format) {
  static constexpr FormatRow kRows[] = {
      {GL_RGBA32F, GL_RGBA, GL_FLOAT},
      {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT},
      {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
  };
  return kRows[static_cast<std::size_t>(format)];
}

// The allocation fails with a GL error, which CheckGl reports.
void Allocate(const GlTexture& texture, int width, int height, const FormatRow& row) {
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, row.internal, width, height, 0, row.format, row.type, nullptr);
  CheckGl(fmt::format("a picture of {}x{}", width, height).c_str());
  ClampAndFilter(GL_TEXTURE_2D, false);
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
}

// Reverses the order of rows: row 0 of OpenGL is the lowest.
template <typename Pixel>
void TurnUpsideDown(std::vector<Pixel>& pixels, std::size_t row) {
  const std::size_t rows = pixels.size() / row;
  for (std::size_t y = 0; y < rows / 2; ++y) {
    std::swap_ranges(&pixels[y * row], &pixels[y * row] + row, &pixels[(rows - 1 - y) * row]);
  }
}

}  // namespace

void ClampAndFilter(GLenum target, bool linear) {
  const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void UploadTexture(GLenum target, const GlTexture& texture, const Texels& of) {
  const auto internal = static_cast<GLint>(of.internal_format);
  glBindTexture(target, texture.id());
  if (target == GL_TEXTURE_1D) {
    glTexImage1D(target, 0, internal, of.width, 0, of.format, of.type, of.data);
  } else if (target == GL_TEXTURE_2D) {
    glTexImage2D(target, 0, internal, of.width, of.height, 0, of.format, of.type, of.data);
  } else {
    glTexImage3D(target, 0, internal, of.width, of.height, of.depth, 0, of.format, of.type,
                 of.data);
  }
  ClampAndFilter(target, true);
}

RenderTarget::RenderTarget(int width, int height, const std::vector<PixelFormat>& formats,
                           Depth depth)
    : width_(width), height_(height), colours_(formats.size()) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  std::vector<GLenum> outputs;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    Allocate(colours_[i], width, height, RowOf(formats[i]));
    outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    glFramebufferTexture2D(GL_FRAMEBUFFER, outputs.back(), GL_TEXTURE_2D, colours_[i].id(), 0);
  }
  glDrawBuffers(static_cast<GLsizei>(outputs.size()), outputs.data());
  if (depth == Depth::k32Bit) {
    Allocate(depth_, width, height, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT});
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  }
  if (formats.empty()) glReadBuffer(GL_NONE);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  ALPENGLOW_ENSURE(status, ==, static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
}

void RenderTarget::Bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
}

void RenderTarget::BindTexture(int unit, std::size_t output) const {
  viewer::BindTexture(unit, GL_TEXTURE_2D, colours_[output]);
}

void RenderTarget::BindDepth(int unit) const { viewer::BindTexture(unit, GL_TEXTURE_2D, depth_); }

void RenderTarget::Write(const Image& image) const {
  ALPENGLOW_ENSURE(image.width, ==, width_);
  ALPENGLOW_ENSURE(image.height, ==, height_);
  std::vector<std::array<float, 3>> rows = image.rgb;
  TurnUpsideDown(rows, static_cast<std::size_t>(width_));
  glBindTexture(GL_TEXTURE_2D, colours_.front().id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_FLOAT, rows.data());
}

template <typename Pixel>
void RenderTarget::ReadInto(std::vector<Pixel>& pixels, std::size_t output, GLenum format) const {
  pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(output));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, format, GL_FLOAT, pixels.data());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  TurnUpsideDown(pixels, static_cast<std::size_t>(width_));
}

void RenderTarget::UseDepthOf(const RenderTarget& other) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, other.depth_.id(), 0);
}

Image RenderTarget::Read() const {
  Image image(width_, height_);
  ReadInto(image.rgb, 0, GL_RGB);
  return image;
}

std::vector<glm::vec4> RenderTarget::ReadValues(std::size_t output) const {
  std::vector<glm::vec4> values;
  ReadInto(values, output, GL_RGBA);
  return values;
}

DisplayImage RenderTarget::ReadBytes() const {
  const std::size_t row = 3 * static_cast<std::size_t>(width_);
  DisplayImage image{width_, height_, {}};
  image.rgb.resize(row * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  TurnUpsideDown(image.rgb, row);
  return image;
}

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

std::optional<std::vector<std::array<float, 3>>> PixelReader::Poll() {
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
