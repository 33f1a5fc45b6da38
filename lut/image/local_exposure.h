// SPDX-License-Identifier: MIT
// This header provides two compressions of an image's range: a roll-off of highlights, and local
// exposure.
//
// WithHighlightsRolledOff is for images that are exposed for the light on a subject. Against the
// sun a sky is 3 to 6 stops brighter than a grey card there, and a print would show it white. A
// luminance t stops over middle grey becomes
//
//   ln(1 + t) stops over it,     t > 0.
//
// The slope is 1 at grey and positive everywhere, so that the sky keeps its gradient. Colours keep
// their hue and chroma. Luminances below grey are unchanged.
//
// LocallyExposed gives every part of an image its own exposure: bright and dark parts move towards
// the middle, detail keeps its contrast.
//
// The logarithm of luminance is split into a base, smoothed by a bilateral filter (which does not
// smooth across edges), and detail; only the base is compressed. Durand and Dorsey (2002), "Fast
// bilateral filtering for the display of high-dynamic-range images"; the filter on a grid of
// position and luminance: Chen, Paris and Durand (2007), "Real-time edge-aware image processing
// with the bilateral grid".
#pragma once

#include "lut/image/image.h"

namespace alpenglow::lut {

/// Returns the image with compressed highlights.
/// @param ev100  the exposure that prints 12.5 / 100 2^ev100 cd/m^2 as middle grey.
[[nodiscard]] Image WithHighlightsRolledOff(Image image, double ev100);

struct LocalExposureOptions {
  double base_range_stops = 5.0;  // range to which the base is compressed; never expanded
  double reach = 0.02;            // radius of the filter, relative to the longer side
  double edge_stops = 1.3;        // larger differences are edges
};

/// Returns the image with a gain per pixel. The gain is 1 where the base has the luminance that
/// `ev100` prints as middle grey. Colours keep their hue. Pixels without light are unchanged.
[[nodiscard]] Image LocallyExposed(const Image& image, double ev100,
                                   const LocalExposureOptions& options = {});

}  // namespace alpenglow::lut
