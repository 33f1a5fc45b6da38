// SPDX-License-Identifier: MIT
// This header provides anti-aliased edges of clipped lights.
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
#include <optional>

#include "lut/image/image.h"

namespace alpenglow::lut {

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
[[nodiscard]] std::optional<ClippedEdge> ClippedEdgeAt(const HdrImage& image, int x, int y,
                                                       float white);

}  // namespace alpenglow::lut
