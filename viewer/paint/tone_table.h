// SPDX-License-Identifier: MIT
// AgX in one of its looks as a table that a graphics card interpolates: nine powers and logarithms a
// pixel, and its hue, are one fetch.
//
// Codes of sRGB over the exposed colour (tone_curve.glsl), which is inside the gamut by then: kSide
// nodes a channel at even steps of its logarithm, from kLowestStop to kHighestStop over saturation.
// Of colours beyond the ends the end is shown: there the curve is flat.
#pragma once

#include <array>
#include <vector>

#include "lut/picture/agx_look.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Error of trilinear interpolation for colours whose channels lie within three stops of each other,
/// in codes of 8 bits: of photo half below 0.06, all but one in a hundred below 0.25, all below 0.9;
/// of other looks, which clip a channel at an edge between nodes, half below 0.1, all but one in
/// twenty below 0.5, all but one in a hundred below 3.
class ToneTable {
 public:
  static constexpr int kSide = 96;
  static constexpr double kLowestStop = -13.5;
  static constexpr double kHighestStop = 5.0;

  /// @param side  nodes a channel, >= 2; the stated errors are those of kSide.
  explicit ToneTable(AgxLook look, int side = kSide);

  [[nodiscard]] int side() const { return side_; }
  /// side()^3 codes in [0, 1], red fastest.
  [[nodiscard]] const std::vector<std::array<float, 3>>& codes() const { return codes_; }

 private:
  int side_;
  std::vector<std::array<float, 3>> codes_;
};

}  // namespace alpenglow::viewer
