// SPDX-License-Identifier: MIT
// Overviews of a series: a contact sheet of all pictures, each small and with a line of text; and a
// keogram, which places the middle columns of the pictures side by side, so that one image shows
// their course (Eather, Mende, Reference 1976, J. Geophys. Res. 81, 3219).
#pragma once

#include <string>
#include <vector>

#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kThumbnailWidth = 320;

/// Returns the picture with its width reduced to at most `width`, with pixels averaged in linear
/// light and without layers. Pictures that are narrow enough are returned unchanged.
[[nodiscard]] Image Reduced(const Image& image, int width);

struct Thumbnail {
  DisplayImage image;
  std::string label;  // digits, ':', '.', '+', '-' and spaces; other characters are left blank
};

/// Returns the thumbnails row by row, in about as many columns as rows. All must have the same
/// size.
[[nodiscard]] DisplayImage ContactSheet(const std::vector<Thumbnail>& thumbnails);

/// Grows by one column per picture.
class Keogram {
 public:
  /// Adds the middle column of a developed picture; all pictures must have the same height.
  void Add(const DisplayImage& picture);

  /// Returns an image with one column per added picture, at least one, and with their height.
  [[nodiscard]] DisplayImage Image() const;

 private:
  int height_ = 0;
  std::vector<std::uint8_t> rgb_;  // column by column
};

}  // namespace alpenglow::renderer
