// SPDX-License-Identifier: MIT
// This header provides models of the eye: adaptation over time, colour and acuity at night, and
// glare.
//
// EyeAdaptation follows light that changes. The eye adapts to more light within seconds. It adapts
// to less light in two ways: at once, by pupil and nerves, to 4 EV below the adaptation of its
// pigments (Ferwerda et al. 1996, "A model of visual adaptation for realistic image synthesis":
// neural adaptation serves over a range of about a log unit and a half); beyond that as fast as
// rods regenerate, 0.24 log units (0.8 EV) a minute (Lamb and Pugh 2004, "Dark adaptation and the
// retinoid cycle of vision", Prog. Retin. Eye Res. 23, 307-380, component S2). Adaptation follows a
// dusk, which loses 0.5 EV a minute at most, without a lag, but lags behind the light of a total
// eclipse.
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
//
// WithGlareOfEye adds the glare of the eye: light that its lens, cornea and retina scatter.
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

#include <optional>

#include "lut/image/image.h"

namespace alpenglow::lut {

class EyeAdaptation {
 public:
  static constexpr double kAtOnce_ev = 4.0, kRegenerated_ev_per_min = 0.8;

  /// Returns the EV that the eye is adapted to. The first call returns the metered EV.
  /// @param metered_ev100  MeterEv100 of the scene in view.
  /// @param seconds  scene time since the last call, of either sign: a step backwards in time
  ///   counts as a step forwards.
  double Follow(double metered_ev100, double seconds);

 private:
  std::optional<double> pigment_ev100_;
};

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
[[nodiscard]] Image SeenByNight(Image image);

/// Returns the finest visible grating [cycles a degree]; below 1e-6 cd/m^2 the value at 1e-6.
/// @param luminance_cd_per_m2 >= 0.
[[nodiscard]] double AcuityAt(double luminance_cd_per_m2);

/// Returns the standard deviation of the spread [rad]: 0 from 5 cd/m^2 on.
[[nodiscard]] double SpreadAt(double luminance_cd_per_m2);

/// Returns the image with the acuity of the eye. Its mean is preserved to float precision; layers
/// are unchanged. Spreads between those of 0, 1/2, 1, 2, ... 64 pixels are mixtures of equal
/// variance; spreads above 64 pixels are limited to 64.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] Image WithAcuityOfNight(Image image, double pixel_rad);

/// Returns the point spread function above [1/sr]. @param angle_rad  >= 0.
[[nodiscard]] double GlareOfEye(double angle_rad);

/// Returns the image with glare; layers are unchanged. It is computed by Fourier transform, within
/// 1e-6 of the sum over all pixels. It needs two arrays of 16 bytes per element, each with four
/// times as many elements as pixels.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] Image WithGlareOfEye(Image image, double pixel_rad);

}  // namespace alpenglow::lut
