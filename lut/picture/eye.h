// SPDX-License-Identifier: MIT
// How an eye follows light that changes. To more light it adapts within seconds. To less light it
// adapts in two ways: at once, by pupil and nerves, to 4 EV less than what its pigments are used to
// (Ferwerda et al. 1996, "A model of visual adaptation for realistic image synthesis": neural
// adaptation serves over a range of about a log unit and a half); beyond that as fast as rods
// regenerate, 0.24 log units (0.8 EV) a minute (Lamb and Pugh 2004, "Dark adaptation and the retinoid
// cycle of vision", Prog. Retin. Eye Res. 23, 307-380, component S2). A dusk, which loses 0.5 EV a
// minute at most, is followed without a lag; the light of a total eclipse is not.
//
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
//
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
//
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

#include <optional>

#include "lut/picture/image.h"

namespace alpenglow::lut {

class EyeAdaptation {
 public:
  static constexpr double kAtOnce_ev = 4.0, kRegenerated_ev_per_min = 0.8;

  /// The EV that the eye is adapted to. At first that is the metered one.
  /// @param metered_ev100  MeterEv100 of what is seen. @param seconds  since the last call, of the
  /// time of the scene; of either sign: light of a moment before is as new as that of one after.
  double Follow(double metered_ev100, double seconds);

 private:
  std::optional<double> pigment_ev100_;
};

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

/// The finest grating [cycles a degree]; below 1e-6 cd/m^2 as there. @param luminance_cd_per_m2 >= 0.
[[nodiscard]] double AcuityAt(double luminance_cd_per_m2);

/// Standard deviation of the spread [rad]: 0 from 5 cd/m^2 on.
[[nodiscard]] double SpreadAt(double luminance_cd_per_m2);

/// The picture as soft as it is seen. Its mean stays, to float; layers are as they were. Spreads lie
/// between those of 0, 1/2, 1, 2, ... 64 pixels as mixtures of the same variance; more than 64 are 64.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] Image WithAcuityOfNight(Image image, double pixel_rad);

/// The point spread function above [1/sr]. @param angle_rad  >= 0.
[[nodiscard]] double GlareOfEye(double angle_rad);

/// The picture as the eye sees it; layers are as they were. By Fourier's transform, within 1e-6 of
/// the sum over all pixels; 16 bytes for each of four times as many, twice.
/// @param pixel_rad  angle between neighbouring pixels in the middle, > 0.
[[nodiscard]] Image WithGlareOfEye(Image image, double pixel_rad);

}  // namespace alpenglow::lut
