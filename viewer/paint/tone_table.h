// SPDX-License-Identifier: MIT
// AgX in its default look as a table that a graphics card interpolates: nine powers and logarithms a
// pixel, and its hue, are one fetch.
//
// Codes of sRGB over the exposed colour (tone_curve.glsl), which is inside the gamut by then: kSide
// nodes a channel at even steps of its logarithm, from kLowestStop to kHighestStop over saturation.
// Of colours beyond the ends the end is shown: there the curve is flat.
#pragma once

#include <array>
#include <vector>

namespace alpenglow {

/// Error of trilinear interpolation for colours whose channels lie within three stops of each other:
/// half below 0.06 codes of 8 bits, all but one in a hundred below 0.25, all below 0.7.
class ToneTable {
 public:
  static constexpr int kSide = 88;
  static constexpr double kLowestStop = -13.5;
  static constexpr double kHighestStop = 3.5;

  ToneTable();

  /// kSide^3 codes in [0, 1], red fastest.
  [[nodiscard]] const std::vector<std::array<float, 3>>& codes() const { return codes_; }

 private:
  std::vector<std::array<float, 3>> codes_;
};

}  // namespace alpenglow
