// SPDX-License-Identifier: MIT
// This header provides the conversion of linear images to 8-bit display images: dither noise and
// anti-aliased edges of clipped lights.
//
// The noise hides the steps of 8-bit images and is identical in every run. It is a tile of blue
// noise by void-and-cluster (Ulichney 1993, Proc. SPIE 1913, 332-343): each of its 64 x 64
// thresholds occurs once, and neighbours differ as much as possible. Its values are reshaped to a
// triangular distribution over (-1, 1) codes, which makes mean and variance of the rounding error
// independent of the signal. The channels read the tile at different offsets. Each repetition of
// the tile is shifted by its own hashed amount. Otherwise the columns of the tile, which are not
// all alike, would line up and show as faint stripes.
//
// The disks of the sun and the moon need anti-aliasing after tone mapping. A disk is thousands of
// times as bright as white, so a pixel that it covers by a hundredth is as white as its middle, and
// its edge shows stairs. The edge is smooth if a display shows the fraction of each pixel that the
// disk covers:
//
//   shown = w [s D(light) + (1 - s) D(beside)] + (1 - w) D(pixel),
//   s = (L - L_beside) / (L_full - L_beside),       L_full = 3 L_2 - 2 L_4,
//
// where D is the tone curve and L are luminances of the linear image, in which the pixel is that
// mixture of light. L_2 and L_4 are the largest luminances within two and four pixels. L_full
// extrapolates from them to the pixel, because the disk, like the sun, may darken towards its edge.
// Near the limb the luminance falls as the root of the distance x from the edge, so the
// extrapolation gives (3 sqrt(2) - 2 sqrt(4)) L' = 0.2 L' instead of 0 there. L_beside is the
// luminance of the background, increased by the rise of an aureole towards the light. Lights that
// the curve can still reproduce need no correction: w rises from 0 at 16 times white to 1 at 256,
// so that the image does not change abruptly while the sun sets. Beside an aureole of over half of
// white, in which the edge is not visible, w falls to 0 at white.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/tone_mapping.h"

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

/// Components of the mixture in a pixel at the edge of a clipped light.
struct ClippedEdge {
  std::array<float, 3> light, beside;  // colours in the unit of the image
  float share;                         // fraction of the light, in [0, 1]
  float weight;                        // w, in (0, 1]
};

/// Returns the mixture of a pixel at the edge of a clipped light. There is one if a light of over
/// 16 times white lies within four pixels, covers a square of 2x2 pixels with about this brightness
/// (smaller sparkles of water and lamps are unchanged), and unclipped pixels lie within four pixels
/// too. An unclipped pixel has a mixture only if it is 1.25 times as bright as its background,
/// because a filter has mixed in the light. Returns nullopt for all other pixels. `beside` is the
/// background on the side away from the light: land along a ridge that cuts the disk, sky
/// elsewhere. For a disk as dark at its limb as the sun and over 8 pixels in radius the error of
/// `share` is at most 0.16. For smaller disks, whose middle lies within four pixels, `share` is
/// less than the covered fraction by up to 0.3.
/// @param white  luminance that a display shows as white, in the image's unit, > 0.
[[nodiscard]] std::optional<ClippedEdge> ClippedEdgeAt(const Image& image, int x, int y,
                                                       float white);

/// Develops an image from Seen(). Throws InternalError for a pixel that is not finite.
[[nodiscard]] DisplayImage Develop(const Image& seen, double ev100, const Look& look);

/// Exposes, tone-maps and dithers an image. Throws InternalError for a pixel that is not finite.
[[nodiscard]] DisplayImage Develop(const Image& image, double ev100, ToneCurve curve);

}  // namespace alpenglow::lut
