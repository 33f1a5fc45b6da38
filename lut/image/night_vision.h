// SPDX-License-Identifier: MIT
// This header provides the vision of the dark-adapted eye: colour and acuity at night.
//
// SeenByNight shows images as the dark-adapted eye sees them: rods take over from cones below 5
// cd/m^2.
//
// Luminance by the CIE system MES2 for mesopic photometry (CIE 191:2010),
//
//   L_mes = (m L_p + (1 - m) L_s V'(l0)) / (m + (1 - m) V'(l0)),    V'(l0) = 683 / 1700
//   m     = a + b log10(L_mes), in [0, 1],                          a = 0.7670, b = 0.3334
//
// is computed from photopic luminance L_p and scotopic luminance L_s, so that m is 1 from 5 cd/m^2
// up and 0 below 0.005 cd/m^2. Every pixel is its own field of adaptation. Rods see no colour:
// their share of the luminance appears as the bluish white of chromaticity (0.25, 0.25) that Jensen
// et al. (2000), "Night rendering", took from paintings of the night. The cones' share keeps its
// colour. Scotopic and photopic luminance have units that agree at 555 nm only. A pixel that rods
// would make brighter than its photopic luminance (two and a half times, for a blue night sky) gets
// the photopic luminance instead.
//
// WithAcuityOfNight softens images of the night by the acuity of the eye in the dark. The finest
// grating of full contrast that is visible at a luminance L [cd/m^2] has
//
//   w = 17.25 atan(1.4 log10 L + 0.35) + 25.72       cycles a degree
//
// This is the fit of Ward Larson, Rushmeier and Piatko (1997), "A visibility matching tone
// reproduction operator", to measurements of Shlaer (1937), J. Gen. Physiol. 21, 165-188: 40 by
// lamps, 7 by the full moon, 2 by stars. Light is spread by the Gaussian that reduces the contrast
// of that grating to a tenth, s = sqrt(ln 10 / 2) / (pi w). The spread at 5 cd/m^2, above which
// rods do not contribute, is subtracted in quadrature, so images by day are unchanged. Every pixel
// is its own field of adaptation and spreads its own light, so that lamps stay sharp, no light is
// lost at edges, and the total never increases.
#pragma once

#include "lut/image/image.h"

namespace alpenglow::lut {

/// Name of the layer of scotopic luminance [scotopic cd/m^2] that SeenByNight needs.
inline constexpr const char* kScotopicChannel = "scotopic.Y";

/// Result of MES2 for a light.
struct MesopicLight {
  double luminance_cd_per_m2 = 0.0;
  double cone_share = 1.0;  // fraction of the luminance, in [0, 1]
};

/// Applies MES2 to a light.
/// @param photopic_cd_per_m2, scotopic_cd_per_m2  >= 0. MES2 has one solution for ratios S/P in
///   [0.25, 5] (lamps 0.3 to 2.5, twilight 3); for other ratios one of its solutions is returned.
///   Error below 1e-6 of the luminance.
[[nodiscard]] MesopicLight MesopicLightOf(double photopic_cd_per_m2, double scotopic_cd_per_m2);

/// Returns the image with mesopic luminance and colour. By day (every pixel over 5 cd/m^2) the
/// image is unchanged. Throws InputError for an image without kScotopicChannel.
[[nodiscard]] HdrImage SeenByNight(HdrImage image);

/// Returns the finest visible grating [cycles a degree]; below 1e-6 cd/m^2 the value at 1e-6.
/// @param luminance_cd_per_m2 >= 0.
[[nodiscard]] double AcuityAt(double luminance_cd_per_m2);

/// Returns the standard deviation of the spread [rad]: 0 from 5 cd/m^2 on.
[[nodiscard]] double SpreadAt(double luminance_cd_per_m2);

/// Returns the image with the acuity of the eye. Its mean is preserved to float precision; layers
/// are unchanged. Spreads between those of 0, 1/2, 1, 2, ... 64 pixels are mixtures of equal
/// variance; spreads above 64 pixels are limited to 64.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] HdrImage WithAcuityOfNight(HdrImage image, double pixel_rad);

}  // namespace alpenglow::lut
