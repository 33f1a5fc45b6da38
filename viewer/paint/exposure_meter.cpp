// SPDX-License-Identifier: MIT
#include "viewer/paint/exposure_meter.h"

#include <algorithm>
#include <utility>

namespace alpenglow::viewer {

MeterReading ReadingOf(const Image& picture, const Look& look) {
  const WhiteBalance white = Settled(look.white, picture, Projection::kCamera);
  const auto ev100 = [](const Image& seen) {
    return MeterEv100(seen, kSunDiskLuminance_cd_per_m2);
  };
  return {white.IsDaylight() ? ev100(picture) : ev100(Balanced(picture, white)), white};
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

void ExposureMeter::LookAt(const RenderTarget& picture) {
  if (reader_.Busy()) return;
  Copy(picture);
  reader_.Begin(*small_, {0, 0, small_->width(), small_->height()});
}

std::optional<MeterReading> ExposureMeter::Take(const Look& look) {
  std::optional<std::vector<std::array<float, 3>>> rgb = reader_.Take();
  if (!rgb) return std::nullopt;
  Image copy(small_->width(), small_->height());
  copy.rgb = std::move(*rgb);
  return ReadingOf(copy, look);
}

MeterReading ExposureMeter::Read(const RenderTarget& picture, const Look& look) {
  reader_.Forget();
  Copy(picture);
  return ReadingOf(small_->Read(), look);
}

}  // namespace alpenglow::viewer
