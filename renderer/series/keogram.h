// SPDX-License-Identifier: MIT
// A keogram: the middle columns of the pictures of a series side by side, so that one image shows
// their course (Eather, Mende, Reference 1976, J. Geophys. Res. 81, 3219).
#pragma once

#include <cstdint>
#include <vector>

#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

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
