// SPDX-License-Identifier: MIT
// This header provides the tone curves of tone_curve.glsl in C++, the looks of AgX, and two
// compressions of an image's range before the curve: a roll-off of highlights, and local exposure.
//
// A look grades the image between the logarithm, the sigmoid and the display.
//
//   printed * 2^opening --inset, log2--> code
//     --(code - grey) contrast + grey, grey = 20/33--> sigmoid --^power-->
//     --y + (code - y) saturation, y luminance of the codes--> outset --toe--> display light
//
// None, medium and high are the base, medium high and high contrast of the configuration that
// Blender ships (Zhou 2023, https://github.com/EaryChow/AgX): contrasts 1, 1.2 and 1.4 of the
// logarithm about middle grey, and saturation 0.95 for the last. Punchy is the look in Sobotka's
// configuration (2022, https://github.com/sobotka/AgX): power 1.3, saturation 1.2.
//
// Photo, the default, brightens by 0.6 stops and has a contrast of 1.8, so that shade by day, 2.5
// stops below metered grey, is black on the display (code 36) and sunlit snow, 1.3 stops above it,
// is white (217). The contrast fades towards white (AgxContrastWithShoulder of tone_curve.glsl),
// and deep shade is shown in proportion to the scene's light (AgxWithToe). Its vibrance gives a
// clear sky at least the chroma which it has in the scene. Vibrance and outset are one spread s of
// the codes about their grey, s = 1 + (1.25 (1 + vibrance) - 1) (1 - d), for a colour at the
// fraction d of the distance from its grey to the border of the cube of codes: pale colours gain,
// and none is moved beyond the border. The hue of blue light is kept: channels that pass a curve
// one by one turn bright blue skies towards violet, by 3 to 11 degrees of OKLab hue. Warm light
// keeps the curve's turn towards yellow, which the eye also sees in bright lights (Bezold and
// Bruecke): the hue of the scene has the weight m (2 - m) (1 - sin hue) / 2, where the sine is 1 at
// OKLab's yellow and -1 at its blue, and 1 - m is the light's d: 0 at the border.
//
// No look shows a tone with more than 1.3 times the chroma (OKLab) that its light has at equal
// lightness. Contrast alone would raise the chroma of dark tones 2 to 4 times and make moonlit snow
// orange.
//
// A colour that then lies outside the display's gamut keeps its luminance and is mixed with the
// grey of that luminance until it is inside.
//
// OKLab: lightness and two opponent colours of linear sRGB. Ottosson (2020), "A perceptual color
// space for image processing", https://bottosson.github.io/posts/oklab.
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

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/shared_glsl/shared_math.h"
#include "lut/image/image.h"
#include "lut/layer.h"

namespace alpenglow::lut {

enum class ToneCurve { kAgx, kAces, kReinhard, kPbrNeutral, kLinear };

enum class AgxLook { kPhoto, kNone, kPunchy, kMedium, kHigh };

/// Largest ratio of the chroma on the display to that of the scene at equal lightness.
inline constexpr double kMostChroma = 1.3;

struct AgxGrade {
  double opening_stops = 0.0;  // brightening of metered middle grey
  double contrast = 1.0;       // contrast of the logarithm, about middle grey
  bool has_shoulder = false;   // the contrast fades towards white (AgxContrastWithShoulder)
  double toe = 0.0;    // fraction of the scene's light in deep shade (AgxWithToe, tone_curve.glsl)
  double power = 1.0;  // exponent of the codes
  double saturation = 1.0;  // saturation of the codes
  double vibrance = 0.0;    // additional saturation of pale colours
  bool keeps_blue = false;  // whether blue light keeps its hue
};

[[nodiscard]] AgxGrade GradeOf(AgxLook look);

/// Converts between a look and its name: "photo", "none", "punchy", "medium" or "high"; throws
/// InputError for another name.
[[nodiscard]] AgxLook AgxLookFromName(const std::string& name);
[[nodiscard]] std::string NameOf(AgxLook look);
[[nodiscard]] std::vector<std::string> AgxLookNames();

template <typename Real>
struct Oklab {
  Real lightness;  // 1 for white
  Real a;          // towards red
  Real b;          // towards yellow
};

template <typename Real>
[[nodiscard]] Oklab<Real> OklabOf(const std::array<Real, 3>& rgb) {
  const auto root = [&](double r, double g, double b) {
    return std::cbrt(Real(r) * rgb[0] + Real(g) * rgb[1] + Real(b) * rgb[2]);
  };
  const Real l = root(0.4122214708, 0.5363325363, 0.0514459929);
  const Real m = root(0.2119034982, 0.6806995451, 0.1073969566);
  const Real s = root(0.0883024619, 0.2817188376, 0.6299787005);
  return {Real(0.2104542553) * l + Real(0.7936177850) * m - Real(0.0040720468) * s,
          Real(1.9779984951) * l - Real(2.4285922050) * m + Real(0.4505937099) * s,
          Real(0.0259040371) * l + Real(0.7827717662) * m - Real(0.8086757660) * s};
}

template <typename Real>
[[nodiscard]] std::array<Real, 3> RgbOf(const Oklab<Real>& lab) {
  const auto cube = [&](double a, double b) {
    const Real root = lab.lightness + Real(a) * lab.a + Real(b) * lab.b;
    return root * root * root;
  };
  const Real l = cube(0.3963377774, 0.2158037573);
  const Real m = cube(-0.1055613458, -0.0638541728);
  const Real s = cube(-0.0894841775, -1.2914855480);
  return {Real(4.0767416621) * l - Real(3.3077115913) * m + Real(0.2309699292) * s,
          Real(-1.2684380046) * l + Real(2.6097574011) * m - Real(0.3413193965) * s,
          Real(-0.0041960863) * l - Real(0.7034186147) * m + Real(1.7076147010) * s};
}

}  // namespace alpenglow::lut

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "lut/image/tone_curve.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::lut {

template <typename Real>
using Rgb = std::array<Real, 3>;

/// Returns the colour without negative channels and with equal luminance (see tone_curve.glsl).
template <typename Real>
[[nodiscard]] Rgb<Real> InsideGamut(const Rgb<Real>& exposed) {
  const Real y = shared::Luminance(exposed[0], exposed[1], exposed[2]);
  const Real smallest = std::min({exposed[0], exposed[1], exposed[2]});
  return {shared::InnerChannel(exposed[0], smallest, y),
          shared::InnerChannel(exposed[1], smallest, y),
          shared::InnerChannel(exposed[2], smallest, y)};
}

/// Returns display light in [0, 1]: a colour outside is mixed with the grey of its luminance.
template <typename Real>
[[nodiscard]] Rgb<Real> InsideDisplay(const Rgb<Real>& light) {
  const Real y = std::clamp(shared::Luminance(light[0], light[1], light[2]), Real(0), Real(1));
  Real share = Real(1);
  for (const Real channel : light) {
    if (channel < Real(0)) share = std::min(share, y / (y - channel));
    if (channel > Real(1)) share = std::min(share, (Real(1) - y) / (channel - y));
  }
  Rgb<Real> inside;
  for (std::size_t c = 0; c < 3; ++c)
    inside[c] = std::clamp(y + (light[c] - y) * share, Real(0), Real(1));
  return inside;
}

/// Returns the fraction of the distance from its grey to the border of the cube at which a colour
/// in [0, 1] lies, in [0, 1]. The result is smooth and never less than the true fraction, because
/// it is the fourth-power norm over the channels instead of the largest channel.
template <typename Real>
[[nodiscard]] Real WayToBorder(const Rgb<Real>& colour, Real grey) {
  Real sum = Real(0);
  for (const Real channel : colour) {
    const Real room = std::max(channel < grey ? grey : Real(1) - grey, Real(1e-6));
    const Real part = (channel - grey) / room;
    sum += part * part * part * part;
  }
  return std::min(std::sqrt(std::sqrt(sum)), Real(1));
}

/// Returns display light with the hue of a printed colour, `scene`, as far as that is blue (header
/// of this file).
[[nodiscard]] inline Rgb<double> WithBlueHueOf(const Oklab<double>& scene,
                                               const Rgb<double>& light) {
  const Oklab<double> shown = OklabOf(light);
  const double scene_chroma = std::hypot(scene.a, scene.b), chroma = std::hypot(shown.a, shown.b);
  if (!(scene_chroma > 1e-6) || !(chroma > 1e-6)) return light;
  const double y = shared::Luminance(light[0], light[1], light[2]);
  const double inside = 1.0 - WayToBorder(light, y);
  const double weight = inside * (2.0 - inside) * 0.5 * (1.0 - scene.b / scene_chroma);
  const double a = shown.a / chroma + weight * (scene.a / scene_chroma - shown.a / chroma);
  const double b = shown.b / chroma + weight * (scene.b / scene_chroma - shown.b / chroma);
  const double length = std::max(std::hypot(a, b), 1e-6);
  return InsideDisplay(
      RgbOf(Oklab<double>{shown.lightness, chroma * a / length, chroma * b / length}));
}

/// Returns display light with less than kMostChroma times the chroma that the printed colour,
/// `scene`, has at equal lightness (header of this file). The limit is smooth, an eighth-power norm
/// of both.
[[nodiscard]] inline Rgb<double> WithChromaNear(const Oklab<double>& scene,
                                                const Rgb<double>& light) {
  const Oklab<double> shown = OklabOf(light);
  if (!(scene.lightness > 1e-6)) return light;
  const double most =
      kMostChroma * std::hypot(scene.a, scene.b) * shown.lightness / scene.lightness;
  const double chroma = std::hypot(shown.a, shown.b);
  if (!(chroma > 1e-5)) return light;
  const double over = chroma / std::max(most, 1e-12);
  const double over2 = std::min(over, 1e12) * std::min(over, 1e12), over4 = over2 * over2;
  const double share = 1.0 / std::sqrt(std::sqrt(std::sqrt(1.0 + over4 * over4)));
  return InsideDisplay(RgbOf(Oklab<double>{shown.lightness, share * shown.a, share * shown.b}));
}

/// Returns codes with the saturation of a color decision list (ASC CDL).
template <typename Real>
[[nodiscard]] Rgb<Real> Saturated(const Rgb<Real>& code, Real saturation) {
  const Real y = shared::Luminance(code[0], code[1], code[2]);
  Rgb<Real> saturated;
  for (std::size_t c = 0; c < 3; ++c)
    saturated[c] = std::max(y + (code[c] - y) * saturation, Real(0));
  return saturated;
}

/// Returns codes after outset and vibrance (header of this file); none is moved beyond the border.
template <typename Real>
[[nodiscard]] Rgb<Real> Vibrant(const Rgb<Real>& code, Real vibrance) {
  constexpr Real kOutset = Real(1.25);
  const Real grey = shared::AgxWhiteShare(code[0], code[1], code[2]);
  const Real way = WayToBorder(code, grey);
  const Real spread = Real(1) + (kOutset * (Real(1) + vibrance) - Real(1)) * (Real(1) - way);
  Rgb<Real> vibrant;
  for (std::size_t c = 0; c < 3; ++c) vibrant[c] = grey + (code[c] - grey) * spread / kOutset;
  return vibrant;
}

/// Returns the graded codes of the curve.
template <typename Real>
[[nodiscard]] Rgb<Real> AgxCodes(const Rgb<Real>& printed, const AgxGrade& grade) {
  const Real share = shared::AgxWhiteShare(printed[0], printed[1], printed[2]);
  const auto contrast = static_cast<Real>(grade.contrast);
  Rgb<Real> code;
  for (std::size_t c = 0; c < 3; ++c) {
    const Real log_code = shared::AgxLogCode(shared::AgxInset(printed[c], share));
    code[c] =
        shared::AgxSigmoid(grade.has_shoulder ? shared::AgxContrastWithShoulder(log_code, contrast)
                                              : shared::AgxContrast(log_code, contrast));
    if (grade.power != 1.0) code[c] = std::pow(code[c], static_cast<Real>(grade.power));
  }
  if (grade.vibrance > 0.0) return Vibrant(code, static_cast<Real>(grade.vibrance));
  return grade.saturation == 1.0 ? code : Saturated(code, static_cast<Real>(grade.saturation));
}

template <typename Real>
[[nodiscard]] Rgb<Real> AgxLight(const Rgb<Real>& printed, AgxLook look) {
  const AgxGrade grade = GradeOf(look);
  const auto opening = static_cast<Real>(std::exp2(grade.opening_stops));
  const Rgb<Real> code =
      AgxCodes<Real>({printed[0] * opening, printed[1] * opening, printed[2] * opening}, grade);
  const Real code_share = shared::AgxWhiteShare(code[0], code[1], code[2]);
  const auto toe = static_cast<Real>(grade.toe);
  Rgb<Real> light;
  for (std::size_t c = 0; c < 3; ++c)
    light[c] = shared::AgxWithToe(shared::AgxLight(code[c], code_share), printed[c], toe);
  // Cube roots and their inverse lose four bits, which float cannot spare.
  const Oklab<double> scene = OklabOf(Rgb<double>{printed[0], printed[1], printed[2]});
  Rgb<double> shown{light[0], light[1], light[2]};
  if (grade.keeps_blue) shown = WithBlueHueOf(scene, shown);
  shown = WithChromaNear(scene, shown);
  return {static_cast<Real>(shown[0]), static_cast<Real>(shown[1]), static_cast<Real>(shown[2])};
}

template <typename Real>
[[nodiscard]] Rgb<Real> AcesLight(const Rgb<Real>& printed) {
  const auto& [red, green, blue] = printed;
  const Rgb<Real> curved = {shared::AcesCurve(shared::AcesRed(red, green, blue)),
                            shared::AcesCurve(shared::AcesGreen(red, green, blue)),
                            shared::AcesCurve(shared::AcesBlue(red, green, blue))};
  return {shared::AcesLightRed(curved[0], curved[1], curved[2]),
          shared::AcesLightGreen(curved[0], curved[1], curved[2]),
          shared::AcesLightBlue(curved[0], curved[1], curved[2])};
}

template <typename Real>
[[nodiscard]] Rgb<Real> ReinhardLight(const Rgb<Real>& printed) {
  const Real y = shared::Luminance(printed[0], printed[1], printed[2]);
  const Real largest = std::max({printed[0], printed[1], printed[2]});
  return {shared::ReinhardLight(printed[0], largest, y),
          shared::ReinhardLight(printed[1], largest, y),
          shared::ReinhardLight(printed[2], largest, y)};
}

template <typename Real>
[[nodiscard]] Rgb<Real> NeutralLight(const Rgb<Real>& printed) {
  const Real largest = std::max({printed[0], printed[1], printed[2]});
  const Real smallest = std::min({printed[0], printed[1], printed[2]});
  return {shared::NeutralLight(printed[0], largest, smallest),
          shared::NeutralLight(printed[1], largest, smallest),
          shared::NeutralLight(printed[2], largest, smallest)};
}

/// Returns linear display light in [0, 1] of a finite linear sRGB colour times `scale`
/// (ExposureScale).
/// @param look  of ToneCurve::kAgx; the other curves have no looks.
template <typename Real>
[[nodiscard]] Rgb<Real> DisplayLight(ToneCurve curve, const Rgb<Real>& rgb, Real scale,
                                     AgxLook look = AgxLook::kPhoto) {
  const Rgb<Real> exposed = InsideGamut<Real>({shared::ExposedChannel(rgb[0], scale),
                                               shared::ExposedChannel(rgb[1], scale),
                                               shared::ExposedChannel(rgb[2], scale)});
  if (curve == ToneCurve::kLinear) {
    return {std::min(exposed[0], Real(1)), std::min(exposed[1], Real(1)),
            std::min(exposed[2], Real(1))};
  }
  const Rgb<Real> printed = {shared::PrintedChannel(exposed[0]), shared::PrintedChannel(exposed[1]),
                             shared::PrintedChannel(exposed[2])};
  switch (curve) {
    case ToneCurve::kAgx:
    case ToneCurve::kLinear:
      break;
    case ToneCurve::kAces:
      return AcesLight(printed);
    case ToneCurve::kReinhard:
      return ReinhardLight(printed);
    case ToneCurve::kPbrNeutral:
      return NeutralLight(printed);
  }
  return AgxLight(printed, look);
}

/// Returns the image with compressed highlights.
/// @param ev100  the exposure that prints 12.5 / 100 2^ev100 cd/m^2 as middle grey.
[[nodiscard]] HdrImage WithHighlightsRolledOff(HdrImage image, double ev100);

struct LocalExposureOptions {
  double base_range_stops = 5.0;  // range to which the base is compressed; never expanded
  double reach = 0.02;            // radius of the filter, relative to the longer side
  double edge_stops = 1.3;        // larger differences are edges
};

/// Returns the image with a gain per pixel. The gain is 1 where the base has the luminance that
/// `ev100` prints as middle grey. Colours keep their hue. Pixels without light are unchanged.
[[nodiscard]] HdrImage LocallyExposed(const HdrImage& image, double ev100,
                                      const LocalExposureOptions& options = {});

}  // namespace alpenglow::lut
