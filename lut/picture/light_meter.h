// SPDX-License-Identifier: MIT
// The light meter of cameras and flights: what of a picture it weighs, and how (MeterEv100, image.h).
//
// Every pixel weighs as much as the solid angle that it stands for. Not metered are
//
//   the sun's disk        brighter than kSunDiskLuminance_cd_per_m2,
//   lamps, glitter        the brightest twentieth of what is left,
//   shade                 the darkest two fifths,
//   black space           what stays black beside the rest: 6 stops below the brightest twentieth
//                         weights begin to fade, at 10 they are nothing.
//
// The mean of the others is printed as middle grey (K = 12.5, ISO 2720): the mean of light and not of
// its logarithm, which would fall faster than the sky where land grows dark, so that a dusk would get
// brighter on the display. But the light below which all but the brightest twentieth lie is never
// printed brighter than white paper beside a
// grey card, 90 % beside 18 %: nobody lets a sunlit planet below a black sky, snow behind a dark
// wood, or fog around lamps run white.
#pragma once

#include <array>
#include <string>

#include "lut/picture/image.h"

namespace alpenglow::lut {

/// The rule in words, for the files that it was used for.
[[nodiscard]] std::string MeterRule();

/// Mean colour of the pixels that the meter takes the mean of, each as bright as the others: linear
/// sRGB of luminance 1. White (1, 1, 1) where there is no light.
[[nodiscard]] std::array<double, 3> MeteredColour(const Image& image, double ignore_above_cd_per_m2,
                                                  Projection projection = Projection::kCamera);

}  // namespace alpenglow::lut
