// SPDX-License-Identifier: MIT
// The exposure meter beside drawing: reads small copies of pictures without waiting for them.
#pragma once

#include <optional>

#include "viewer/gl/pixel_reader.h"
#include "viewer/gl/render_target.h"

namespace alpenglow {

class ExposureMeter {
 public:
  /// Copies every so-manieth pixel, at most kLongSide a row, and begins to read them; nothing while
  /// an earlier copy is still being read.
  void Look(const RenderTarget& picture);
  /// What MeterEv100 makes of the copy, once it has arrived.
  [[nodiscard]] std::optional<double> Take();
  /// The same at once, waiting for the graphics card.
  [[nodiscard]] double Read(const RenderTarget& picture);

  static constexpr int kLongSide = 160;

 private:
  void Copy(const RenderTarget& picture);

  std::optional<RenderTarget> small_;
  PixelReader reader_;
};

}  // namespace alpenglow
