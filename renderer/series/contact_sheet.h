// SPDX-License-Identifier: MIT
// A contact sheet: all pictures of a series in one picture, each small and with a line of text.
#pragma once

#include <string>
#include <vector>

#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kThumbnailWidth = 320;

/// Returns the picture with its width reduced to at most `width`, with pixels averaged in linear
/// light and without layers. Pictures that are narrow enough are returned unchanged.
[[nodiscard]] HdrImage Reduced(const HdrImage& image, int width);

struct Thumbnail {
  DisplayImage image;
  std::string label;  // digits, ':', '.', '+', '-' and spaces; other characters are left blank
};

/// Returns the thumbnails row by row, in about as many columns as rows. All must have the same
/// size.
[[nodiscard]] DisplayImage ContactSheet(const std::vector<Thumbnail>& thumbnails);

}  // namespace alpenglow::renderer
