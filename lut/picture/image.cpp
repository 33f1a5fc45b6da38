// SPDX-License-Identifier: MIT
#include "lut/picture/image.h"

#include "atmosphere/text/error.h"

namespace alpenglow {

Image::Image(int image_width, int image_height) : width(image_width), height(image_height) {
  RequireInRange(image_width, 1, kLargestImageSide, "image width");
  RequireInRange(image_height, 1, kLargestImageSide, "image height");
  rgb.resize(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height));
}

}  // namespace alpenglow
