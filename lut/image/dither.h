// SPDX-License-Identifier: MIT
// This header provides the noise with which images are rounded to 8 bits.
//
// The noise hides the steps of 8-bit images and is identical in every run. It is a tile of blue
// noise by void-and-cluster (Ulichney 1993, Proc. SPIE 1913, 332-343): each of its 64 x 64
// thresholds occurs once, and neighbours differ as much as possible. Its values are reshaped to a
// triangular distribution over (-1, 1) codes, which makes mean and variance of the rounding error
// independent of the signal. The channels read the tile at different offsets. Each repetition of
// the tile is shifted by its own hashed amount. Otherwise the columns of the tile, which are not
// all alike, would line up and show as faint stripes.
#pragma once

#include <cstdint>
#include <vector>

#include "lut/layer.h"

namespace alpenglow::lut {

inline constexpr int kDitherTileSize = 64;

/// Returns the ranks 0 ... 4095 of the tile, row by row.
[[nodiscard]] const std::vector<std::uint16_t>& DitherTile();

/// Column and row of the tile at which its repetition (x, y) begins.
struct DitherShift {
  int x, y;
};
[[nodiscard]] DitherShift DitherShiftOf(int tile_x, int tile_y);

/// Returns the noise [codes] in (-1, 1), triangular, of a pixel and channel (0, 1, 2).
[[nodiscard]] float DitherNoise(int x, int y, int channel);

/// Returns the code 0 ... 255 of a code value in [0, 255] dithered by `noise`. Exact black and
/// white are unchanged: within half a code of the ends the noise is reduced.
[[nodiscard]] std::uint8_t DitheredCode(float code, float noise);

}  // namespace alpenglow::lut
