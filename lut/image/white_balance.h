// SPDX-License-Identifier: MIT
// This header provides white balance: which light a developed image shows as white.
//
// Light of chromaticity w is shown as the display's white, D65, by complete von Kries adaptation in
// the space of CAT16 (Li et al. 2017, Color Research and Application 42, 703-718):
//
//   XYZ' = M^-1 diag(M D65 / M w) M XYZ,     Y of w kept
//
// The light of a temperature is that of CIE 224:2017 (TM-30): Planck's up to 4000 K, the daylight
// of CIE 15 from 5000 K on, between them a mixture of both at equal luminance. Daylight is D65,
// 6504 K, which leaves colours unchanged. Auto takes the mean colour of the metered pixels as the
// colour of the light, as far as that is a light between 3000 K and 7000 K.
//
// Camera, the default, is the setting of a photographer: photographic daylight (5500 K, D55 of ISO
// 7589) by day, which shows sunlit clouds and snow as white, and 4000 K under moon and stars. Moonlight and airglow are warmer than sunlight, and 4000 K keeps such images from looking
// brown. From EV 4 (the end of civil twilight) to EV -2 (a full moon) of the image's meter the
// temperature changes smoothly, in mireds, from one to the other.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/image/image.h"
#include "lut/layer.h"

namespace alpenglow::lut {

struct WhiteBalance {
  enum class Kind { kDaylight, kAuto, kKelvin, kCamera };
  Kind kind = Kind::kDaylight;
  std::optional<double> kelvin = {};  // for kKelvin, and for kAuto and kCamera after Settled

  /// Returns whether colours are unchanged.
  [[nodiscard]] bool IsDaylight() const;
  /// Returns whether the white balance depends on the image.
  [[nodiscard]] bool IsOfPicture() const { return kind == Kind::kAuto || kind == Kind::kCamera; }

  bool operator==(const WhiteBalance&) const = default;
};

/// Colour temperature of D65, the white of the display.
inline constexpr double kDaylight_k = 6504.0;
/// Colour temperature of a camera's daylight.
inline constexpr double kCameraDaylight_k = 5500.0;

/// Range of temperatures that users can choose [K].
inline constexpr double kWarmestWhite_k = 1500.0;
inline constexpr double kCoolestWhite_k = 25000.0;

/// Parses "camera", "daylight", "auto" or kelvins, as 5600 or 5600K; throws InputError for another
/// text.
[[nodiscard]] WhiteBalance WhiteBalanceFromText(const std::string& text);
/// Returns the names that WhiteBalanceFromText parses, without kelvins.
[[nodiscard]] std::vector<std::string> WhiteBalanceNames();
/// Returns a name: "daylight (D65)", "auto", "auto, 4310 K, CAT16", "camera, 5500 K, CAT16", "5600
/// K, CAT16".
[[nodiscard]] std::string NameOf(const WhiteBalance& white);

/// Returns XYZ of the light of a temperature, Y = 1. @param kelvin in [kWarmestWhite_k,
/// kCoolestWhite_k].
[[nodiscard]] std::array<double, 3> WhiteOfTemperature(double kelvin);
/// Returns the temperature of the light whose chromaticity is nearest in CIE 1960 uv, to 0.1 mired,
/// within the range above. @param xyz  Y > 0.
[[nodiscard]] double TemperatureOf(const std::array<double, 3>& xyz);

/// Returns the temperature of kCamera [K] for an image of a metered EV.
[[nodiscard]] double CameraWhite(double metered_ev100);

/// Returns the white balance with the kelvins of auto or camera for an image; other kinds are
/// unchanged.
[[nodiscard]] WhiteBalance Settled(const WhiteBalance& white, const HdrImage& image,
                                   Projection projection);

/// Returns the matrix from linear sRGB of the scene to linear sRGB as shown. Throws InternalError
/// if auto or camera are not settled.
[[nodiscard]] Matrix3 BalancingMatrix(const WhiteBalance& white);

/// Returns the balanced image; its layers are unchanged. With daylight the image is unchanged.
[[nodiscard]] HdrImage Balanced(HdrImage image, const WhiteBalance& white);

}  // namespace alpenglow::lut
