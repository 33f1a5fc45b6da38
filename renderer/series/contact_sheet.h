// SPDX-License-Identifier: MIT
// All pictures of a series on one, small, with a line of text each.
//
// A keogram: of each picture of a series its middle column, side by side, so that one picture shows
// how all of them follow each other (Eather, Mende, Judge 1976, J. Geophys. Res. 81, 3219).
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

/// Grows by a column a picture.
class Keogram {
 public:
  /// Adds the middle column of a developed picture; all must be equally high.
  void Add(const DisplayImage& picture);

  /// As wide as pictures were added, one at least, and as high as they are.
  [[nodiscard]] DisplayImage Image() const;

 private:
  int height_ = 0;
  std::vector<std::uint8_t> rgb_;  // column by column
};

}  // namespace alpenglow::renderer
