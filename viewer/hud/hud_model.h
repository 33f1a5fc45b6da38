// SPDX-License-Identifier: MIT
// Data of instruments and panels: values shown in one frame, colours, and number formats.
//
// HudModel holds plain values, refilled for every frame. Angles are in radians, azimuths and
// headings clockwise from north, heights and speeds in SI.
//
// The day theme has bright colours; the night theme is red and amber, which keeps the eye
// dark-adapted. Text has a dark outline or a panel behind it, with a contrast of at least 4.5 (Web
// Content Accessibility Guidelines 2.1, 1.4.3) over any picture, up to white.
//
// Number texts are short, of even width, and have units.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viewer/flight/pilot.h"

namespace alpenglow::viewer {

enum class HudTheme { kDay, kNight };
enum class HudThemeChoice { kAuto, kDay, kNight };

/// Red, green, blue of the display and opacity, each in [0, 1].
using HudColour = std::array<float, 4>;

struct HudColours {
  HudColour text, quiet, accent, warning;  // of text and lines
  HudColour shadow;                        // around lines
  HudColour outline;                       // around text
  HudColour panel, control, active;        // of panels
};
[[nodiscard]] const HudColours& ColoursOf(HudTheme theme);

/// Returns the theme for a choice. kAuto switches to the night theme when the exposure falls below
/// the end of civil twilight, EV 1, and back to the day theme above EV 3, so that it does not
/// flicker at dusk.
[[nodiscard]] HudTheme ThemeFor(HudThemeChoice choice, double ev100, HudTheme before);

struct HudFlight {
  std::string mode;  // "free camera", "light aircraft", "replay", ...
  double heading_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;                // clockwise seen from behind
  double fov_rad = 1.0471975511965976;  // horizontal
  double horizon_dip_rad = 0.0;         // dip of the sea horizon below the horizontal plane
  double ground_speed_m_per_s = 0.0;
  std::optional<double> air_speed_m_per_s = {};
  double height_m = 0.0;  // over the ellipsoid, which approximates sea level
  double above_ground_m = 0.0;
  double climb_m_per_s = 0.0;
  std::optional<double> throttle = {};     // fraction, [0, 1]
  std::optional<double> load_factor = {};  // g
  std::optional<Course> path = {};         // empty at rest
  bool stall = false;
};

struct HudTime {
  std::string utc;            // "2026-06-21 04:00:00Z"
  std::string local;          // "13:00:00"
  std::string zone;           // "UTC+9", "Asia/Tokyo"
  double day_fraction = 0.5;  // of the day shown in the strip, [0, 1]
  double rate = 1.0;          // seconds of the scene per real second
  bool paused = false;
};

struct HudMoon {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  double lit_share = 1.0;  // fraction of the disk
};

struct HudSky {
  double sun_azimuth_rad = 0.0;
  double sun_elevation_rad = 0.0;
  std::optional<HudMoon> moon = {};
};

struct HudExposure {
  double ev100 = 15.0;
  bool locked = false;
  double compensation_ev = 0.0;  // added to the meter's value; positive is brighter
  std::optional<double> cursor_luminance_cd_per_m2 = {};
};

struct HudAir {
  std::string planet;                // name of the medium
  double visibility_km = 50.0;       // of the air at altitude 0
  double visibility_here_km = 50.0;  // at the camera, also in media
  double aerosol_scale = 1.0;        // factor on the aerosol of the planet
  double ozone_du = 300.0;           // 0 for air without ozone
  double ground_albedo = 0.1;
};

struct HudSpeed {
  double frame_ms = 16.0;  // typical time of a frame in the last second
  std::string quality;     // "auto: medium, 0.75x"
};

/// A transient message.
struct HudMessage {
  std::string text;
  bool is_warning = false;
};

struct HudProgress {
  std::string text;    // "loading N46E008.hgt"
  double share = 0.0;  // finished fraction, [0, 1]
};

enum class HudUnits { kMetric, kAviation };

/// Cells of a row of the table of tables: "air", "12 ms", "".
using HudRow = std::vector<std::string>;

struct HudModel {
  HudFlight flight;
  AutopilotTargets autopilot;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  HudTime time;
  HudSky sky;
  HudExposure exposure;
  HudAir air;
  bool landing_light = false;
  HudSpeed speed;
  std::vector<HudMessage> messages;  // the newest last
  std::optional<HudProgress> progress = {};
  bool recording = false;
  HudUnits units = HudUnits::kMetric;
  std::vector<HudRow> tables;  // tables of the viewer: name, time to make it, memory
};

/// Preferences of the user that only change the display.
struct HudPreferences {
  HudThemeChoice theme = HudThemeChoice::kAuto;
  HudUnits units = HudUnits::kMetric;
};

/// Return "46.5000° N", "8.0000° W".
[[nodiscard]] std::string LatitudeText(double latitude_deg);
[[nodiscard]] std::string LongitudeText(double longitude_deg);

/// Returns "007": integer degrees in [0, 360).
[[nodiscard]] std::string HeadingText(double heading_rad);
/// Returns "-0.8°".
[[nodiscard]] std::string DegreesText(double angle_rad);

/// A number, its unit, and the number of units in one metre or one metre per second.
struct Quantity {
  std::string number, unit;
  double per_si = 1.0;
};
/// Returns "3200 m".
[[nodiscard]] std::string Joined(const Quantity& quantity);
/// Returns m up to 100 km and km beyond; in aviation units feet up to 100 000 and nautical miles
/// beyond.
[[nodiscard]] Quantity HeightText(double height_m, HudUnits units);
/// Returns km/h up to 10 000 and km/s beyond; in aviation units knots up to 10 000 and nautical
/// miles per second beyond.
[[nodiscard]] Quantity SpeedText(double speed_m_per_s, HudUnits units);
/// Returns m/s, or feet per minute in aviation units, with sign.
[[nodiscard]] Quantity ClimbText(double climb_m_per_s, HudUnits units);

/// Returns three significant digits, without exponents from 0.0001 to 10 million: "8200 cd/m²".
[[nodiscard]] std::string LuminanceText(double luminance_cd_per_m2);

/// Returns "x1", "x-60", "x0.5", "paused".
[[nodiscard]] std::string RateText(double rate, bool paused);

}  // namespace alpenglow::viewer
