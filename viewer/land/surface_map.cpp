// SPDX-License-Identifier: MIT
#include "viewer/land/surface_map.h"

#include <array>

#include "atmosphere/text/error.h"
#include "viewer/gl/render_target.h"

namespace alpenglow {
namespace {

void Attach(const GlTexture& texture, GLenum attachment, GLint format, GLenum components, int width,
            int height) {
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, components, GL_FLOAT, nullptr);
  ClampAndFilter(GL_TEXTURE_2D, false);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.id(), 0);
}

}  // namespace

SurfaceMap::SurfaceMap(int width, int height) : width_(width), height_(height) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  Attach(surface_, GL_COLOR_ATTACHMENT0, GL_RGBA32F, GL_RGBA, width, height);
  Attach(sky_, GL_COLOR_ATTACHMENT1, GL_RGBA16F, GL_RGBA, width, height);
  Attach(depth_, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, width, height);
  constexpr std::array<GLenum, 2> kBoth{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(kBoth.size(), kBoth.data());
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  ALPENGLOW_ENSURE(status, ==, static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
}

void SurfaceMap::Bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
}

void SurfaceMap::BindTextures(int surface_unit, int sky_unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(surface_unit));
  glBindTexture(GL_TEXTURE_2D, surface_.id());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(sky_unit));
  glBindTexture(GL_TEXTURE_2D, sky_.id());
}

std::vector<glm::vec4> SurfaceMap::Read(int location) const {
  std::vector<glm::vec4> pixels(static_cast<std::size_t>(width_) *
                                static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(location));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels.data());
  return pixels;
}

}  // namespace alpenglow
