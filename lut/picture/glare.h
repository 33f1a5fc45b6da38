// SPDX-License-Identifier: MIT
// Glare of the eye: light that its lens, cornea and retina scatter beside where it came from.
//
// A pixel of a picture that is looked at is the mean of all others by the point spread function of
// the light-adapted eye, over the angle t in degrees [1/sr]:
//
//   p = 0.384 f0 + 0.478 f1 + 0.138 f2,     f0 = 2.61e6 exp(-(t / 0.02)^2),
//                                           f1 = 20.91 / (t + 0.02)^3,   f2 = 72.37 / (t + 0.02)^2
//
// Spencer, Shirley, Zimmerman, Greenberg (1995), "Physically-based glare effects for digital
// images", SIGGRAPH, section 3. What of it lies within the pixel itself stays there. Beyond the
// edge of the picture there is no light, and none comes from there. The angle between two pixels is
// taken as if all were as wide as those in the middle: in a picture 60 degrees wide those at its
// edge are a quarter narrower. Streaks and the ring of colours are left out: they come from lashes
// and from a pupil that is wide.
#pragma once

#include "lut/picture/image.h"

namespace alpenglow::lut {

/// The point spread function above [1/sr]. @param angle_rad  >= 0.
[[nodiscard]] double GlareOfEye(double angle_rad);

/// The picture as the eye sees it; layers are as they were. By Fourier's transform, within 1e-6 of
/// the sum over all pixels; 16 bytes for each of four times as many, twice.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] Image WithGlareOfEye(Image image, double pixel_rad);

}  // namespace alpenglow::lut
