// SPDX-License-Identifier: MIT
// This header provides the conversion of linear images to 8-bit display images: exposure, tone
// curve, dither noise (dither.h) and anti-aliased edges of clipped lights (clipped_edge.h).
#pragma once

#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {

/// Exposes, tone-maps and dithers an image from Seen(). Throws InternalError for a pixel that is not
/// finite.
[[nodiscard]] DisplayImage Develop(const HdrImage& seen, double ev100, const Look& look);

}  // namespace alpenglow::lut
