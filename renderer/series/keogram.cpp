// SPDX-License-Identifier: MIT
#include "renderer/series/keogram.h"

#include <algorithm>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

void Keogram::Add(const DisplayImage& picture) {
  if (rgb_.empty()) height_ = picture.height;
  ALPENGLOW_ENSURE(picture.height, ==, height_);
  for (int y = 0; y < height_; ++y) {
    const auto pixel =
        picture.rgb.begin() + 3 * (std::ptrdiff_t{y} * picture.width + picture.width / 2);
    rgb_.insert(rgb_.end(), pixel, pixel + 3);
  }
}

DisplayImage Keogram::Image() const {
  ALPENGLOW_ENSURE(rgb_.size(), >, 0U);
  const auto height = static_cast<std::size_t>(height_);
  const std::size_t width = rgb_.size() / (3 * height);
  DisplayImage image{static_cast<int>(width), height_, std::vector<std::uint8_t>(rgb_.size())};
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) {
      std::copy_n(&rgb_[3 * (x * height + y)], 3, &image.rgb[3 * (y * width + x)]);
    }
  }
  return image;
}

}  // namespace alpenglow::renderer
