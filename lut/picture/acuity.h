// SPDX-License-Identifier: MIT
// Acuity of the eye in the dark: pictures of the night are soft.
//
// The finest grating of full contrast that is seen at a luminance L [cd/m^2] has
//
//   w = 17.25 atan(1.4 log10 L + 0.35) + 25.72       cycles a degree
//
// the fit of Ward Larson, Rushmeier and Piatko (1997), "A visibility matching tone reproduction
// operator", to what Shlaer (1937), J. Gen. Physiol. 21, 165-188, measured: 40 by lamps, 7 by the
// full moon, 2 by stars. Light is spread by the Gaussian that leaves a tenth of the contrast of that
// grating, s = sqrt(ln 10 / 2) / (pi w), less that of 5 cd/m^2, from where on rods have no part:
// day is as sharp as it was. Every pixel is its own field of adaptation and spreads its own light,
// so that lamps stay sharp, nothing is lost at edges, and the whole is never brighter.
#pragma once

#include "lut/picture/image.h"

namespace alpenglow::lut {

/// The finest grating [cycles a degree]; below 1e-6 cd/m^2 as there. @param luminance_cd_per_m2 >= 0.
[[nodiscard]] double AcuityAt(double luminance_cd_per_m2);

/// Standard deviation of the spread [rad]: 0 from 5 cd/m^2 on.
[[nodiscard]] double SpreadAt(double luminance_cd_per_m2);

/// The picture as soft as it is seen. Its mean stays, to float; layers are as they were. Spreads lie
/// between those of 0, 1/2, 1, 2, ... 64 pixels as mixtures of the same variance; more than 64 are 64.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] Image WithAcuityOfNight(Image image, double pixel_rad);

}  // namespace alpenglow::lut
