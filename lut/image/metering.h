// SPDX-License-Identifier: MIT
// This header provides the light meter of cameras and flights (MeterEv100).
//
// The meter weights every pixel by its solid angle. It excludes
//
//   the sun's disk        brighter than kSunDiskLuminance_cd_per_m2,
//   lamps, glitter        the brightest twentieth of the remaining pixels,
//   shade                 the darkest two fifths,
//   black space           pixels that stay black beside the rest: their weights fade from 6 stops
//                         below the brightest twentieth to 0 at 10 stops.
//
// The mean of the others is printed as middle grey (K = 12.5, ISO 2720). It is the mean of
// luminance, not of its logarithm: the logarithmic mean would fall faster than the sky where land
// grows dark, so that a dusk would get brighter on the display. In addition, the luminance exceeded
// only by the brightest twentieth is never printed brighter than white paper beside a grey card,
// 90 % beside 18 %. This keeps a sunlit planet below a black sky, snow behind a dark wood, and the
// glow around lamps from being overexposed.
#pragma once

#include <array>
#include <string>

#include "lut/image/image.h"

namespace alpenglow::lut {

/// Returns the scale from luminance to exposed values for an exposure value at ISO 100. A luminance
/// of 2^EV100 * 1.2 cd/m^2 saturates (Lagarde, de Rousiers 2014).
[[nodiscard]] double ExposureScale(double ev100);

/// Constant K of reflected-light meters [cd s / (m^2 ISO)], ISO 2720: EV100 = log2(100 L / K).
inline constexpr double kMeterConstant = 12.5;

/// Range of the meter: from a moonless night to the sun's surroundings.
inline constexpr double kDarkestEv100 = -12.0;
inline constexpr double kBrightestEv100 = 20.0;

/// Luminance above which the exposure meter treats a pixel as part of the sun's disk [cd/m^2].
inline constexpr double kSunDiskLuminance_cd_per_m2 = 1e6;

/// Returns the EV100 of a histogram meter: mean luminance between the 40th and 95th
/// percentile mapped to middle grey by K = 12.5, or more if the 95th percentile would exceed white
/// by day. Pixels brighter than `ignore_above_cd_per_m2` (the sun's disk), pixels without light,
/// and pixels that stay black beside the rest (space) do not count. Pixels of a panorama are
/// weighted by their solid angle. The result lies within [kDarkestEv100, kBrightestEv100], the
/// limits of the camera: a night of stars by f/1.4 for 30 s at ISO 25600, and sunlit snow eight
/// times over. Without light it is kDarkestEv100.
[[nodiscard]] double MeterEv100(const HdrImage& image, double ignore_above_cd_per_m2,
                                Projection projection = Projection::kCamera);

/// Returns the rule in words, for the metadata of output files.
[[nodiscard]] std::string MeterRule();

/// Returns the mean colour of the pixels whose mean is metered, each scaled to equal luminance:
/// linear sRGB of luminance 1. Returns white (1, 1, 1) if there is no light.
[[nodiscard]] std::array<double, 3> MeteredColour(const HdrImage& image,
                                                  double ignore_above_cd_per_m2,
                                                  Projection projection = Projection::kCamera);

}  // namespace alpenglow::lut
