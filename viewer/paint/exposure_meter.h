// SPDX-License-Identifier: MIT
// The exposure meter beside drawing: reads small copies of pictures without waiting for them.
#pragma once

#include <optional>

#include "lut/picture/look.h"
#include "viewer/gl/pixel_reader.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

/// What a picture says of its light.
struct MeterReading {
  double ev100;        // MeterEv100 of the picture as it is seen
  WhiteBalance white;  // settled
};

/// Of a picture as a camera has it. @param look  not settled.
[[nodiscard]] MeterReading ReadingOf(const Image& picture, const Look& look);

class ExposureMeter {
 public:
  /// Copies every so-manieth pixel, at most kLongSide a row, and begins to read them; nothing while
  /// an earlier copy is still being read.
  void LookAt(const RenderTarget& picture);
  /// The reading of the copy, once it has arrived.
  [[nodiscard]] std::optional<MeterReading> Take(const Look& look);
  /// Of a picture at once, waiting for the graphics card. Copies of earlier ones are not read any more.
  [[nodiscard]] MeterReading Read(const RenderTarget& picture, const Look& look);

  static constexpr int kLongSide = 160;

 private:
  void Copy(const RenderTarget& picture);

  std::optional<RenderTarget> small_;
  PixelReader reader_;
};

}  // namespace alpenglow::viewer
