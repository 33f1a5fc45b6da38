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
//
// White balance: which light a developed picture shows as white.
//
// Light of chromaticity w is shown as the display's white, D65, by complete von Kries adaptation in
// the space of CAT16 (Li et al. 2017, Color Research and Application 42, 703-718):
//
//   XYZ' = M^-1 diag(M D65 / M w) M XYZ,     Y of w kept
//
// The light of a temperature is that of CIE 224:2017 (TM-30): Planck's up to 4000 K, the daylight of
// CIE 15 from 5000 K on, between them a mixture of both at equal luminance. Daylight is D65, 6504 K:
// colours stay as they are. Auto takes the mean colour of what the meter weighs (metering.h) for
// the light, as far as that is a light between 3000 K and 7000 K.
//
// Camera, the default, is what a photographer sets: daylight by day, and 4000 K under moon and stars,
// which keeps their pictures from looking brown: moonlight is warmer than sunlight, and so is airglow.
// From EV 4 (the end of civil twilight) to EV -2 (a full moon) of the picture's meter the temperature
// goes from one to the other, in mireds, without an edge.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "atmosphere/colour/spectrum.h"
#include "lut/layer.h"
#include "lut/picture/image.h"

namespace alpenglow::lut {

/// The rule in words, for the files that it was used for.
[[nodiscard]] std::string MeterRule();

/// Mean colour of the pixels that the meter takes the mean of, each as bright as the others: linear
/// sRGB of luminance 1. White (1, 1, 1) where there is no light.
[[nodiscard]] std::array<double, 3> MeteredColour(const Image& image, double ignore_above_cd_per_m2,
                                                  Projection projection = Projection::kCamera);

struct WhiteBalance {
  enum class Kind { kDaylight, kAuto, kKelvin, kCamera };
  Kind kind = Kind::kDaylight;
  std::optional<double> kelvin = {};  // of kKelvin, and of kAuto and kCamera once they are settled

  /// It is true where colours stay as they are.
  [[nodiscard]] bool IsDaylight() const;
  /// It is true where each picture has another one.
  [[nodiscard]] bool IsOfPicture() const { return kind == Kind::kAuto || kind == Kind::kCamera; }

  bool operator==(const WhiteBalance&) const = default;
};

/// D65, the white of the display.
inline constexpr double kDaylight_k = 6504.0;

/// Temperatures that can be asked for [K].
inline constexpr double kWarmestWhite_k = 1500.0;
inline constexpr double kCoolestWhite_k = 25000.0;

/// "camera", "daylight", "auto" or kelvins, as 5600 or 5600K; throws InputError for another text.
[[nodiscard]] WhiteBalance WhiteBalanceFromText(const std::string& text);
/// "daylight (D65)", "auto", "auto, 4310 K, CAT16", "camera, 6504 K, CAT16", "5600 K, CAT16".
[[nodiscard]] std::string NameOf(const WhiteBalance& white);

/// XYZ of the light of a temperature, Y = 1. @param kelvin in [kWarmestWhite_k, kCoolestWhite_k].
[[nodiscard]] std::array<double, 3> WhiteOfTemperature(double kelvin);
/// The temperature of the light whose chromaticity is nearest in CIE 1960 uv, to 0.1 mired, within
/// the range above. @param xyz  Y > 0.
[[nodiscard]] double TemperatureOf(const std::array<double, 3>& xyz);

/// The temperature of camera [K] for a picture that is metered at an EV.
[[nodiscard]] double CameraWhite(double metered_ev100);

/// The white balance with the kelvins that auto or camera has for a picture; others stay as they are.
[[nodiscard]] WhiteBalance Settled(const WhiteBalance& white, const Image& image,
                                   Projection projection);

/// Linear sRGB as it is shown from linear sRGB. Of auto and camera settled; InternalError before.
[[nodiscard]] Matrix3 BalancingMatrix(const WhiteBalance& white);

/// The picture, balanced; its layers are as they were. Of daylight the same picture.
[[nodiscard]] Image Balanced(Image image, const WhiteBalance& white);

}  // namespace alpenglow::lut
