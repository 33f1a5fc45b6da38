// SPDX-License-Identifier: MIT
// All pictures of a series on one, small, with a line of text each.
#pragma once

#include <string>
#include <vector>

#include "lut/picture/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kThumbnailWidth = 320;

/// The picture with its width reduced to `width` or less, pixels averaged in linear light; layers
/// are left out. Pictures that are narrow enough stay as they are.
[[nodiscard]] Image Reduced(const Image& image, int width);

struct Thumbnail {
  DisplayImage image;
  std::string label;  // digits, ':', '.', '+', '-' and spaces; others are left blank
};

/// The thumbnails row by row, about as many columns as rows. All must have the same size.
[[nodiscard]] DisplayImage ContactSheet(const std::vector<Thumbnail>& thumbnails);

}  // namespace alpenglow::renderer
