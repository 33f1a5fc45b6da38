// SPDX-License-Identifier: MIT
#include "viewer/paint/exposure_meter.h"

#include <algorithm>
#include <utility>

namespace alpenglow {

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
  if (reader_.Busy()) return;
  Copy(picture);
  reader_.Begin(*small_, {0, 0, small_->width(), small_->height()});
}

std::optional<double> ExposureMeter::Take() {
  std::optional<std::vector<std::array<float, 3>>> rgb = reader_.Take();
  if (!rgb) return std::nullopt;
  Image copy(small_->width(), small_->height());
  copy.rgb = std::move(*rgb);
  return MeterEv100(copy, kSunDiskLuminance_cd_per_m2);
}

double ExposureMeter::Read(const RenderTarget& picture) {
  Copy(picture);
  return MeterEv100(small_->Read(), kSunDiskLuminance_cd_per_m2);
}

}  // namespace alpenglow
