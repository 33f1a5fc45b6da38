// SPDX-License-Identifier: MIT
// Highlights of a picture that was exposed for the light on a subject. Against the sun a sky is 3 to 6
// stops brighter than a grey card there, and a print would show it white. A luminance t stops over
// middle grey becomes
//
//   ln(1 + t) stops over it,     t > 0:
//
// slope 1 at grey, and a slope everywhere, so that the sky keeps its gradient. Colours keep their hue
// and chroma; what is darker than grey stays as it is.
//
// An exposure of its own for every part of a picture: bright and dark parts move towards the
// middle, detail keeps its contrast.
//
// The logarithm of luminance is split into a base, smoothed by a bilateral filter (which does not
// smooth across edges), and detail; the base alone is compressed. Durand and Dorsey (2002), "Fast
// bilateral filtering for the display of high-dynamic-range images"; the filter on a grid of
// position and luminance: Chen, Paris and Durand (2007), "Real-time edge-aware image processing
// with the bilateral grid".
#pragma once

#include "lut/picture/image.h"

namespace alpenglow::lut {

/// @param ev100  the exposure that prints 12.5 / 100 2^ev100 cd/m^2 as middle grey.
[[nodiscard]] Image WithHighlightsRolledOff(Image image, double ev100);

struct LocalExposureOptions {
  double base_range_stops = 5.0;  // what the base's range is compressed to; never stretched
  double reach = 0.02;            // of the filter, part of the longer side
  double edge_stops = 1.3;        // differences beyond are edges
};

/// The picture with a gain per pixel; the gain is 1 where the base has the luminance that `ev100`
/// prints as middle grey. Colours keep their hue. Pixels without light stay so.
[[nodiscard]] Image LocallyExposed(const Image& image, double ev100,
                                   const LocalExposureOptions& options = {});

}  // namespace alpenglow::lut
