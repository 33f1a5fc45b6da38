// SPDX-License-Identifier: MIT
// Noise that hides the steps of 8-bit pictures, the same in every run.
//
// A tile of blue noise by void-and-cluster (Ulichney 1993, Proc. SPIE 1913, 332-343): each of its
// 64 x 64 thresholds once, neighbours as different as can be. Its values are reshaped to a
// triangular distribution over (-1, 1) codes, which makes mean and variance of the rounding error
// independent of the signal; the channels read the tile at different offsets. Each repetition of
// the tile is shifted by its own hashed amount: columns of one tile, which are not all alike, would
// stand over each other as faint stripes.
//
// Edges of the sun's and the moon's disk on a display. The disk is thousands of times as bright as
// white: a pixel that it covers by a hundredth is as white as its middle, and its edge becomes stairs.
// A display that shows the share of each pixel that the disk covers has a smooth edge:
//
//   shown = w [s D(light) + (1 - s) D(beside)] + (1 - w) D(pixel),
//   s = (L - L_beside) / (L_full - L_beside),       L_full = 3 L_2 - 2 L_4,
//
// D the tone curve, L luminances of the linear picture, in which the pixel is that mixture of light.
// L_2 and L_4 are the brightest within two and four pixels: from there the light that grows darker
// towards its edge, as the sun does, goes on to where the pixel is. Over the limb it falls as the
// root of the distance x from the edge: (3 sqrt(2) - 2 sqrt(4)) L' = 0.2 L' instead of 0 there.
// L_beside is what lies behind, brighter by as much as it grows towards the light: an aureole.
// A light that a curve still holds needs none of it: w rises from 0 at 16 times white to 1 at 256, so
// that nothing jumps while the sun sets. Beside an aureole of over half of white, in which the edge
// is lost, w falls to 0 at white.
//
// This header also reads the shared text dither.glsl as C++.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "atmosphere/dialect/shared_math.h"
#include "lut/picture/image.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "lut/picture/dither.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

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

/// What a pixel on the edge of a clipped light is a mixture of.
struct ClippedEdge {
  std::array<float, 3> light, beside;  // colours like those of the picture
  float share;                         // of the light, in [0, 1]
  float weight;                        // w, in (0, 1]
};

/// The mixture, where there is one: a light of over 16 times white lies within four pixels, as
/// bright in a square of 2x2 pixels (sparkles of water and lamps, which are smaller, are left as
/// they are), and light that is not clipped does so, too. Nothing for all other pixels, but those that
/// are not clipped and yet 1.25 times as bright as what lies behind, which filters mix. `beside` is
/// what lies away from the light: land along a ridge that cuts the disk, sky elsewhere. Of a disk
/// as dark at its limb as the sun and over 8 pixels in radius the share is right to 0.16; of smaller
/// ones, of which four pixels see the middle, it is less than the share covered by up to 0.3.
/// @param white  luminance that a display shows as white, in the picture's unit, > 0.
[[nodiscard]] std::optional<ClippedEdge> ClippedEdgeAt(const Image& image, int x, int y,
                                                       float white);

}  // namespace alpenglow::lut
