// SPDX-License-Identifier: MIT
// Numbers as instruments write them: short, of even width, with units.
#pragma once

#include <string>

#include "viewer/hud/hud_model.h"

namespace alpenglow::viewer {

/// "46.5000° N", "8.0000° W".
[[nodiscard]] std::string LatitudeText(double latitude_rad);
[[nodiscard]] std::string LongitudeText(double longitude_rad);

/// "007": whole degrees in [0, 360).
[[nodiscard]] std::string HeadingText(double heading_rad);
/// "-0.8°".
[[nodiscard]] std::string DegreesText(double angle_rad);

/// A number, what it is counted in, and how many of these are one metre or one metre a second.
struct Quantity {
  std::string number, unit;
  double per_si = 1.0;
};
/// "3200 m".
[[nodiscard]] std::string Joined(const Quantity& quantity);
/// Metric: m up to 100 km, km beyond. Aviation: feet up to 100 000, nautical miles beyond.
[[nodiscard]] Quantity HeightText(double height_m, HudUnits units);
/// Metric: km/h up to 10 000, km/s beyond. Aviation: knots up to 10 000, nautical miles a second.
[[nodiscard]] Quantity SpeedText(double speed_m_per_s, HudUnits units);
/// Metric: m/s, with its sign. Aviation: feet a minute.
[[nodiscard]] Quantity ClimbText(double climb_m_per_s, HudUnits units);

/// Three digits that count, without exponents from 0.0001 to 10 million: "8200 cd/m²".
[[nodiscard]] std::string LuminanceText(double luminance_cd_per_m2);

/// "x1", "x-60", "x0.5", "paused".
[[nodiscard]] std::string RateText(double rate, bool paused);

}  // namespace alpenglow::viewer
