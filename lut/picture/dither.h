// SPDX-License-Identifier: MIT
// Noise that hides the steps of 8-bit pictures, the same in every run.
//
// A tile of blue noise by void-and-cluster (Ulichney 1993, Proc. SPIE 1913, 332-343): each of its
// 64 x 64 thresholds once, neighbours as different as can be. Its values are reshaped to a
// triangular distribution over (-1, 1) codes, which makes mean and variance of the rounding error
// independent of the signal; the channels read the tile at different offsets. Each repetition of
// the tile is shifted by its own hashed amount: columns of one tile, which are not all alike, would
// stand over each other as faint stripes.
#pragma once

#include <cstdint>
#include <vector>

namespace alpenglow::lut {

inline constexpr int kDitherTileSize = 64;

/// Ranks 0 ... 4095 of the tile, row by row.
[[nodiscard]] const std::vector<std::uint16_t>& DitherTile();

/// Column and row of the tile at which its repetition (x, y) begins.
struct DitherShift {
  int x, y;
};
[[nodiscard]] DitherShift DitherShiftOf(int tile_x, int tile_y);

/// Noise [codes] in (-1, 1), triangular, of a pixel and channel (0, 1, 2).
[[nodiscard]] float DitherNoise(int x, int y, int channel);

/// The code 0 ... 255 of a code value in [0, 255] dithered by `noise`. Exact black and white stay
/// what they are: within half a code of the ends the noise is reduced.
[[nodiscard]] std::uint8_t DitheredCode(float code, float noise);

}  // namespace alpenglow::lut
