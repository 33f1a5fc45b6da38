// SPDX-License-Identifier: MIT
#include "viewer/paint/spot_meter.h"

#include "lut/picture/tone_curve.h"

namespace alpenglow::viewer {

std::optional<double> SpotMeter::At(const RenderTarget& picture, double right, double down) {
  if (!reader_) reader_.emplace();
  if (const auto pixels = reader_->Take()) {
    const std::array<float, 3>& rgb = pixels->front();
    luminance_ = shared::Luminance<double>(static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
                                           static_cast<double>(rgb[2]));
  }
  reader_->Begin(picture, {static_cast<int>(right * picture.width()),
                           picture.height() - 1 - static_cast<int>(down * picture.height()), 1, 1});
  return luminance_;
}

void SpotMeter::Leave() {
  reader_.reset();
  luminance_.reset();
}

}  // namespace alpenglow::viewer
