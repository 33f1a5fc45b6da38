// SPDX-License-Identifier: MIT
#include "viewer/paint/exposure_meter.h"

#include <algorithm>
#include <cstring>

#include "viewer/gl/gl_context.h"

namespace alpenglow {

ExposureMeter::~ExposureMeter() {
  if (arrives_ != nullptr) glDeleteSync(arrives_);
}

void ExposureMeter::Copy(const RenderTarget& picture) {
  const int longest = std::max(picture.width(), picture.height());
  const auto shrunk = [&](int side) {
    return std::clamp(side * kLongSide / longest, 1, std::max(side, 1));
  };
  const int width = shrunk(picture.width()), height = shrunk(picture.height());
  Fit(small_, width, height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, small_->framebuffer());
  glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, 0, width, height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void ExposureMeter::Look(const RenderTarget& picture) {
  if (arrives_ != nullptr) return;
  Copy(picture);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, small_->framebuffer());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.id());
  const auto bytes =
      static_cast<GLsizeiptr>(sizeof(float) * 3) * small_->width() * small_->height();
  glBufferData(GL_PIXEL_PACK_BUFFER, bytes, nullptr, GL_STREAM_READ);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, small_->width(), small_->height(), GL_RGB, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  arrives_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  CheckGl("ExposureMeter::Look");
}

std::optional<double> ExposureMeter::Take() {
  if (arrives_ == nullptr) return std::nullopt;
  const GLenum state = glClientWaitSync(arrives_, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) return std::nullopt;
  glDeleteSync(arrives_);
  arrives_ = nullptr;
  Image copy(small_->width(), small_->height());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.id());
  glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0,
                     static_cast<GLsizeiptr>(copy.rgb.size() * sizeof(copy.rgb[0])),
                     copy.rgb.data());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  return MeterEv100(copy, kSunDiskLuminance_cd_per_m2);
}

double ExposureMeter::Read(const RenderTarget& picture) {
  Copy(picture);
  return MeterEv100(small_->Read(), kSunDiskLuminance_cd_per_m2);
}

}  // namespace alpenglow
