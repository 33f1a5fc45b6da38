// SPDX-License-Identifier: MIT
// This header provides the glare of the eye: light that its lens, cornea and retina scatter.
//
// Each pixel becomes the mean of all pixels weighted by the point spread function of the
// light-adapted eye, over the angle t in degrees [1/sr]:
//
//   p = 0.384 f0 + 0.478 f1 + 0.138 f2,     f0 = 2.61e6 exp(-(t / 0.02)^2),
//                                           f1 = 20.91 / (t + 0.02)^3,   f2 = 72.37 / (t + 0.02)^2
//
// Spencer, Shirley, Zimmerman, Greenberg (1995), "Physically-based glare effects for digital
// images", SIGGRAPH, section 3. The part of the function that lies within the pixel itself stays
// there. No light comes from beyond the edge of the image. The angle between two pixels is computed
// as if all pixels were as wide as those in the middle: in an image 60 degrees wide those at its
// edge are a quarter narrower. Streaks and the ring of colours are left out: they come from lashes
// and from a wide pupil.
#pragma once

#include "lut/image/image.h"

namespace alpenglow::lut {

/// Returns the point spread function above [1/sr]. @param angle_rad  >= 0.
[[nodiscard]] double GlareOfEye(double angle_rad);

/// Returns the image with glare; layers are unchanged. It is computed by Fourier transform, within
/// 1e-6 of the sum over all pixels. It needs two arrays of 16 bytes per element, each with four
/// times as many elements as pixels.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] HdrImage WithGlareOfEye(HdrImage image, double pixel_rad);

}  // namespace alpenglow::lut
