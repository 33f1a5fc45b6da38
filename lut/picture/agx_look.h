// SPDX-License-Identifier: MIT
// Looks of AgX: how its picture is graded between the logarithm, the sigmoid and the display.
//
//   printed * 2^opening --inset, log2--> code
//     --(code - grey) contrast + grey, grey = 20/33--> sigmoid --^power-->
//     --y + (code - y) saturation, y luminance of the codes--> outset --toe--> display light
//
// None, medium and high are the base, medium high and high contrast of the configuration that
// Blender ships (Zhou 2023, https://github.com/EaryChow/AgX): contrasts 1, 1.2 and 1.4 of the
// logarithm about middle grey, and saturation 0.95 of the last. Punchy is the look in Sobotka's own
// (2022, https://github.com/sobotka/AgX): power 1.3, saturation 1.2.
//
// Photo, the default, is opened by 0.6 stops and has a contrast of 1.8, so that shade by day, 2.5 stops
// under what the meter took for grey, is black on the display (code 36) and sunlit snow, 1.3 over it,
// is white (217). The contrast fades towards white (AgxContrastWithShoulder of tone_curve.glsl), and
// deep shade is shown in proportion to the scene's light (AgxWithToe). Its vibrance gives a clear sky
// at least the chroma which it has in the scene. Vibrance and outset are one spread s of the
// codes about their grey, s = 1 + (1.25 (1 + vibrance) - 1) (1 - d), for a colour that is d of the
// way from its grey to the border of the cube of codes: pale colours gain, and none is pushed over
// the border. The hue of blue light is kept: channels that pass a curve one by one turn bright blue
// skies towards violet, by 3 to 11 degrees of OKLab hue. Warm light keeps the curve's turn towards
// yellow, which eyes know from bright lights (Bezold and Bruecke): the hue of the scene has the
// weight m (2 - m) (1 - sin hue) / 2, where the sine is 1 at OKLab's yellow and -1 at its blue, and
// 1 - m is the light's d: 0 at the border.
//
// No look shows a tone with more than 1.3 times the chroma (OKLab) that its light has at the same
// lightness: contrast alone would raise that of dark tones 2 to 4 times, and moonlit snow be orange.
//
// A colour that then lies outside the display's gamut keeps its luminance and is mixed with the
// grey of that luminance until it is inside.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace alpenglow::lut {

enum class AgxLook { kPhoto, kNone, kPunchy, kMedium, kHigh };

/// Most chroma on the display beside that of the scene at the same lightness.
inline constexpr double kMostChroma = 1.3;

struct AgxGrade {
  double opening_stops = 0.0;  // what the meter took for middle grey is printed brighter by
  double contrast = 1.0;       // of the logarithm, about middle grey
  bool has_shoulder = false;   // the contrast fades towards white (AgxContrastWithShoulder)
  double toe = 0.0;    // share of the scene's light in deep shade (AgxWithToe, tone_curve.glsl)
  double power = 1.0;  // of the codes
  double saturation = 1.0;  // of the codes
  double vibrance = 0.0;    // more saturation of pale colours
  bool keeps_blue = false;  // the hue of blue light
};

[[nodiscard]] AgxGrade GradeOf(AgxLook look);

/// "photo", "none", "punchy", "medium" or "high"; throws InputError for another name.
[[nodiscard]] AgxLook AgxLookFromName(const std::string& name);
[[nodiscard]] std::string NameOf(AgxLook look);
[[nodiscard]] std::vector<std::string> AgxLookNames();

}  // namespace alpenglow::lut
