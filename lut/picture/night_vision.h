// SPDX-License-Identifier: MIT
// Pictures as the dark-adapted eye sees them: rods take over from cones below 5 cd/m^2.
//
// Luminance by the CIE system MES2 for mesopic photometry (CIE 191:2010),
//
//   L_mes = (m L_p + (1 - m) L_s V'(l0)) / (m + (1 - m) V'(l0)),    V'(l0) = 683 / 1700
//   m     = a + b log10(L_mes), in [0, 1],                          a = 0.7670, b = 0.3334
//
// from photopic luminance L_p and scotopic luminance L_s, so that m is 1 from 5
// cd/m^2 up and 0 below 0.005 cd/m^2. Every pixel is taken as its own field of
// adaptation. Rods see no colour: their share of the luminance appears as the
// bluish white of chromaticity (0.25, 0.25) that Jensen et al. (2000), "Night
// rendering", took from paintings of the night; the cones' share keeps its colour. Scotopic and
// photopic luminance have units that agree at 555 nm only; where rods would make a pixel brighter than
// its photopic luminance (two and a half times, of a blue night sky), it has the latter.
#pragma once

#include "lut/picture/image.h"

namespace alpenglow::lut {

/// The layer of scotopic luminance [scotopic cd/m^2] that a picture for the night needs.
inline constexpr const char* kScotopicChannel = "scotopic.Y";

/// What MES2 makes of a light.
struct MesopicLight {
  double luminance_cd_per_m2 = 0.0;
  double cone_share = 1.0;  // of the luminance, in [0, 1]
};

/// @param photopic_cd_per_m2, scotopic_cd_per_m2  >= 0. MES2 has one solution for ratios S/P in
/// [0.25, 5] (lamps 0.3 to 2.5, twilight 3); beyond, one of its solutions. Error below 1e-6 of the
/// luminance.
[[nodiscard]] MesopicLight MesopicLightOf(double photopic_cd_per_m2, double scotopic_cd_per_m2);

/// The picture with mesopic luminance and colour. By day (every pixel over 5 cd/m^2) the same
/// picture. Throws InputError for one without kScotopicChannel.
[[nodiscard]] Image SeenByNight(Image image);

}  // namespace alpenglow::lut
