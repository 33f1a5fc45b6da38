// SPDX-License-Identifier: MIT
// The luminance of the picture under the pointer.
#pragma once

#include <optional>

#include "viewer/gl/pixel_reader.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

/// Asked once a frame, it never waits for the graphics card: what it tells is a frame or two old.
class SpotMeter {
 public:
  /// [cd/m^2], at shares of width and height from the upper left, each in [0, 1). Nothing before the
  /// first has arrived.
  [[nodiscard]] std::optional<double> At(const RenderTarget& picture, double right, double down);
  /// Nothing is pointed at.
  void Leave();

 private:
  std::optional<PixelReader> reader_;
  std::optional<double> luminance_;
};

}  // namespace alpenglow::viewer
