// SPDX-License-Identifier: MIT
#include "viewer/hud/hud_model.h"

#include <fmt/format.h>

#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/units.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

const HudColours& ColoursOf(HudTheme theme) {
  static constexpr HudColours kDay{
      .text = {0.94F, 1.0F, 0.95F, 1.0F},
      .quiet = {0.83F, 0.90F, 0.87F, 1.0F},
      .accent = {0.45F, 1.0F, 0.55F, 1.0F},
      .warning = {1.0F, 0.88F, 0.40F, 1.0F},
      .shadow = {0.0F, 0.0F, 0.0F, 0.55F},
      .outline = {0.0F, 0.0F, 0.0F, 0.70F},
      .panel = {0.07F, 0.09F, 0.12F, 0.93F},
      .control = {0.22F, 0.30F, 0.38F, 0.90F},
      .active = {0.24F, 0.46F, 0.60F, 1.0F},
  };
  static constexpr HudColours kNight{
      .text = {0.95F, 0.42F, 0.08F, 1.0F},
      .quiet = {0.90F, 0.41F, 0.08F, 1.0F},
      .accent = {0.95F, 0.48F, 0.06F, 1.0F},
      .warning = {1.0F, 0.34F, 0.08F, 1.0F},
      .shadow = {0.0F, 0.0F, 0.0F, 0.75F},
      .outline = {0.0F, 0.0F, 0.0F, 1.0F},
      .panel = {0.04F, 0.01F, 0.005F, 0.92F},
      .control = {0.20F, 0.05F, 0.02F, 0.95F},
      .active = {0.33F, 0.09F, 0.03F, 1.0F},
  };
  return theme == HudTheme::kDay ? kDay : kNight;
}

HudTheme ThemeFor(HudThemeChoice choice, double ev100, HudTheme before) {
  constexpr double kNightBelow = 1.0, kDayAbove = 3.0;
  if (choice == HudThemeChoice::kDay) return HudTheme::kDay;
  if (choice == HudThemeChoice::kNight) return HudTheme::kNight;
  if (before == HudTheme::kDay) return ev100 < kNightBelow ? HudTheme::kNight : HudTheme::kDay;
  return ev100 > kDayAbove ? HudTheme::kDay : HudTheme::kNight;
}

namespace {

constexpr double kLargeNumber = 1e5;
constexpr double kFastNumber = 1e4;

// Angles that round to 0 or 180 degrees have one text on both sides.
std::string CoordinateText(double angle_deg, char positive, char negative) {
  constexpr double kSteps = 1e4;  // per degree
  const double degrees = std::round(kSteps * angle_deg) / kSteps;
  return fmt::format("{:.4f}° {}", std::abs(degrees),
                     degrees < 0.0 && degrees > -180.0 ? negative : positive);
}

/// Rounds to an integer, and writes "0" for "-0".
std::string Whole(double value) {
  return fmt::format("{:.0f}", std::round(value) == 0.0 ? 0.0 : value);
}

// Converts to units of `unit_m`, or to larger units from `many` of them on.
Quantity Scaled(double value_m, double unit_m, const char* unit, double many, double large_m,
                const char* large) {
  if (std::abs(value_m) < many * unit_m) return {Whole(value_m / unit_m), unit, 1.0 / unit_m};
  return {fmt::format("{:.1f}", value_m / large_m), large, 1.0 / large_m};
}

}  // namespace

std::string Joined(const Quantity& quantity) { return quantity.number + " " + quantity.unit; }

std::string LatitudeText(double latitude_deg) { return CoordinateText(latitude_deg, 'N', 'S'); }
std::string LongitudeText(double longitude_deg) { return CoordinateText(longitude_deg, 'E', 'W'); }

std::string HeadingText(double heading_rad) {
  const double turns = heading_rad / (2.0 * kPi);
  const int degrees = static_cast<int>(std::lround((turns - std::floor(turns)) * 360.0)) % 360;
  return fmt::format("{:03d}", degrees);
}

std::string DegreesText(double angle_rad) {
  const double degrees = angle_rad / kRadiansPerDegree;
  return fmt::format("{:+.1f}°", std::abs(degrees) < 0.05 ? 0.0 : degrees);
}

Quantity HeightText(double height_m, HudUnits units) {
  if (units == HudUnits::kMetric) return Scaled(height_m, 1.0, "m", kLargeNumber, 1000.0, "km");
  return Scaled(height_m, kMetresPerFoot, "ft", kLargeNumber, kMetresPerNauticalMile, "nmi");
}

Quantity SpeedText(double speed_m_per_s, HudUnits units) {
  if (units == HudUnits::kMetric)
    return Scaled(speed_m_per_s, 1.0 / 3.6, "km/h", kFastNumber, 1000.0, "km/s");
  return Scaled(speed_m_per_s, kMetresPerNauticalMile / 3600.0, "kt", kFastNumber,
                kMetresPerNauticalMile, "nmi/s");
}

Quantity ClimbText(double climb_m_per_s, HudUnits units) {
  if (units == HudUnits::kMetric)
    return {fmt::format("{:+.1f}", std::abs(climb_m_per_s) < 0.05 ? 0.0 : climb_m_per_s), "m/s",
            1.0};
  constexpr double kPerSi = 60.0 / kMetresPerFoot;
  const double feet_per_minute = climb_m_per_s * kPerSi;
  return {fmt::format("{:+.0f}", std::abs(feet_per_minute) < 0.5 ? 0.0 : feet_per_minute), "ft/min",
          kPerSi};
}

std::string LuminanceText(double luminance_cd_per_m2) {
  if (luminance_cd_per_m2 < 1e-4 || luminance_cd_per_m2 >= 1e7)
    return fmt::format("{:.2e} cd/m²", luminance_cd_per_m2);
  const int before_point = static_cast<int>(std::floor(std::log10(luminance_cd_per_m2))) + 1;
  const double digit = std::pow(10.0, before_point - 3);
  return fmt::format("{:.{}f} cd/m²", std::round(luminance_cd_per_m2 / digit) * digit,
                     std::max(3 - before_point, 0));
}

std::string RateText(double rate, bool paused) {
  return paused ? "paused" : fmt::format("x{:g}", rate);
}

}  // namespace alpenglow::viewer
