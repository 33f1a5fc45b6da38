// SPDX-License-Identifier: MIT
// A keogram: of each picture of a series its middle column, side by side, so that one picture shows
// how all of them follow each other (Eather, Mende, Judge 1976, J. Geophys. Res. 81, 3219).
#pragma once

#include "lut/picture/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

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
