// SPDX-License-Identifier: MIT
// Highlights of a picture that was exposed for the light on a subject. Against the sun a sky is 3 to 6
// stops brighter than a grey card there, and a print would show it white. A luminance t stops over
// middle grey becomes
//
//   ln(1 + t) stops over it,     t > 0:
//
// slope 1 at grey, and a slope everywhere, so that the sky keeps its gradient. Colours keep their hue
// and chroma; what is darker than grey stays as it is.
#pragma once

#include "lut/picture/image.h"

namespace alpenglow::lut {

/// @param ev100  the exposure that prints 12.5 / 100 2^ev100 cd/m^2 as middle grey.
[[nodiscard]] Image WithHighlightsRolledOff(Image image, double ev100);

}  // namespace alpenglow::lut
