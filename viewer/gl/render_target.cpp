// SPDX-License-Identifier: MIT
#include "viewer/gl/render_target.h"

#include <algorithm>
#include <array>
#include <vector>

#include "atmosphere/text/error.h"

namespace alpenglow {

void ClampAndFilter(GLenum target, bool linear) {
  const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

RenderTarget::RenderTarget(int width, int height, Depth depth) : width_(width), height_(height) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glBindTexture(GL_TEXTURE_2D, colour_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
  ClampAndFilter(GL_TEXTURE_2D, false);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.id(), 0);
  if (depth == Depth::k32Bit) {
    glBindTexture(GL_TEXTURE_2D, depth_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, nullptr);
    ClampAndFilter(GL_TEXTURE_2D, false);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  }
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  ALPENGLOW_ENSURE(status, ==, static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
}

void RenderTarget::Bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
}

void RenderTarget::BindTexture(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, colour_.id());
}

void RenderTarget::Write(const Image& image) const {
  ALPENGLOW_ENSURE(image.width, ==, width_);
  ALPENGLOW_ENSURE(image.height, ==, height_);
  std::vector<std::array<float, 3>> rows(image.rgb.size());
  for (int y = 0; y < height_; ++y) {  // OpenGL's row 0 is the lowest
    std::copy_n(&image.at(0, y), width_,
                rows.begin() + static_cast<std::ptrdiff_t>(height_ - 1 - y) * width_);
  }
  glBindTexture(GL_TEXTURE_2D, colour_.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_FLOAT, rows.data());
}

Image RenderTarget::Read() const {
  Image image(width_, height_);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_FLOAT, image.rgb.data());
  for (int y = 0; y < height_ / 2; ++y) {  // OpenGL's row 0 is the lowest
    std::swap_ranges(&image.at(0, y), &image.at(0, y) + width_, &image.at(0, height_ - 1 - y));
  }
  return image;
}

}  // namespace alpenglow
