// SPDX-License-Identifier: MIT
// Colours of instruments and panels: bright ones for the day, red and amber ones that leave the eye
// adapted to the dark. What is written has a plate or a panel behind it, and a contrast to it of 4.5
// at least (Web Content Accessibility Guidelines 2.1, 1.4.3), whatever the picture is, up to white.
//
// All that instruments and panels show of one moment: plain values, filled anew for every frame.
//
// Angles in radians, azimuths and headings clockwise from north, heights and speeds in SI.
//
// What was asked for in panels during one frame: each value at most once, most of the time none.
//
// Numbers as instruments write them: short, of even width, with units.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::viewer {

enum class HudTheme { kDay, kNight };
enum class HudThemeChoice { kAuto, kDay, kNight };

/// Red, green, blue of the display and opacity, each in [0, 1].
using HudColour = std::array<float, 4>;

struct HudColours {
  HudColour text, quiet, accent, warning;  // what is written and drawn
  HudColour shadow;                        // around it
  HudColour plate;                         // behind it
  HudColour panel, control, active;        // of panels
};
[[nodiscard]] const HudColours& ColoursOf(HudTheme theme);

/// The theme of a choice; kAuto takes the night's when the exposure falls below the end of civil
/// twilight, EV 1, and the day's again above EV 3, so that no dusk flickers.
[[nodiscard]] HudTheme ThemeFor(HudThemeChoice choice, double ev100, HudTheme before);

/// Where the eye, or what carries it, is going.
struct HudDirection {
  double heading_rad = 0.0;
  double climb_rad = 0.0;  // above the horizontal plane
};

struct HudFlight {
  std::string mode;  // "free camera", "light aircraft", "replay", ...
  double heading_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;                // clockwise seen from behind
  double fov_rad = 1.0471975511965976;  // horizontal
  double horizon_dip_rad = 0.0;         // of the edge of the sea below the horizontal plane
  double ground_speed_m_per_s = 0.0;
  std::optional<double> air_speed_m_per_s = {};
  double height_m = 0.0;  // over the ellipsoid, which stands for the sea
  double above_ground_m = 0.0;
  double climb_m_per_s = 0.0;
  std::optional<double> throttle = {};     // share, [0, 1]
  std::optional<double> load_factor = {};  // g
  std::optional<HudDirection> path = {};   // none while standing
  bool stall = false;
};

/// The values that are held.
struct HudAutopilot {
  std::optional<double> heading_rad = {};
  std::optional<double> height_m = {};
  std::optional<double> speed_m_per_s = {};
};

struct HudTime {
  std::string utc;            // "2026-06-21 04:00:00Z"
  std::string local;          // "13:00:00"
  std::string zone;           // "UTC+9", "Asia/Tokyo"
  double day_fraction = 0.5;  // of the day that the strip shows, [0, 1]
  double rate = 1.0;          // seconds of the scene per second of the pilot
  bool paused = false;
};

struct HudMoon {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  double lit_share = 1.0;  // of its disk
};

struct HudSky {
  double sun_azimuth_rad = 0.0;
  double sun_elevation_rad = 0.0;
  std::optional<HudMoon> moon = {};
};

struct HudExposure {
  double ev100 = 15.0;
  bool locked = false;
  double compensation_ev = 0.0;  // added to what the meter says; over 0 is brighter
  std::optional<double> cursor_luminance_cd_per_m2 = {};
  std::string tone_curve;              // one of HudChoices::tone_curves
  std::string look;                    // one of HudChoices::looks; of the curve agx
  std::string white_balance;           // one of HudChoices::white_balances, or "5600 K"
  std::optional<double> white_k = {};  // temperature of the light that is shown as white [K]
};

struct HudAir {
  std::string planet;                // one of HudChoices::planets
  std::string mixture;               // one of HudChoices::mixtures
  double visibility_km = 50.0;       // of the air at altitude 0
  double visibility_here_km = 50.0;  // at the camera, also in fog
  double aerosol_scale = 1.0;        // on what the mixture has
  double ozone_du = 300.0;           // 0 where the air has none
  double ground_albedo = 0.1;
};

struct HudSpeed {
  double frame_ms = 16.0;  // a typical one of the last second
  std::string quality;     // "auto: medium, 0.75x"
};

/// Something to be said once.
struct HudMessage {
  std::string text;
  bool is_warning = false;
};

struct HudProgress {
  std::string text;    // "loading N46E008.hgt"
  double share = 0.0;  // done, [0, 1]
};

enum class HudUnits { kMetric, kAviation };

struct HudModel {
  HudFlight flight;
  HudAutopilot autopilot;
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  HudTime time;
  HudSky sky;
  HudExposure exposure;
  HudAir air;
  HudSpeed speed;
  std::vector<HudMessage> messages;  // the newest last
  std::optional<HudProgress> progress = {};
  bool recording = false;
  HudUnits units = HudUnits::kMetric;
};

/// A lamp of the scene, or the landing light.
struct HudLamp {
  std::string name;
  bool is_on = true;
};

/// A row of a table: "sky view", "64 x 104", "0.2 %", ...; columns as in its heading.
using HudRow = std::vector<std::string>;

/// What panels offer and list; changes rarely.
struct HudChoices {
  std::vector<std::string> modes;     // of flight
  std::vector<std::string> moments;   // "sunrise", "noon", "moonrise", ...
  std::vector<std::string> planets;   // presets of the atmosphere
  std::vector<std::string> mixtures;  // of aerosol; none: there is no list of them
  std::vector<std::string> tone_curves, looks, white_balances;
  std::vector<std::string> qualities;  // "auto", "low", ...
  std::vector<HudLamp> lamps;
  HudRow table_heading;
  std::vector<HudRow> tables;  // of the viewer: size, age, error
};

/// Degrees and metres as they were typed; the panel keeps them in range.
struct HudPlaceRequest {
  double latitude_deg = 0.0;   // [-90, 90]
  double longitude_deg = 0.0;  // [-180, 180]
  double height_m = 0.0;       // over the ellipsoid
};

struct HudTimeRequest {
  std::optional<std::string> instant = {};  // as typed; ParseInstant (time.h) is its judge
  std::optional<double> day_fraction = {};  // a click into the strip of the day, [0, 1]
  std::optional<std::string> moment = {};   // one of HudChoices::moments
  std::optional<double> rate = {};          // [-3600, 3600]
  std::optional<bool> paused = {};
};

struct HudAirRequest {
  std::optional<std::string> planet = {};
  std::optional<std::string> mixture = {};
  std::optional<double> visibility_km = {};
  std::optional<double> aerosol_scale = {};
  std::optional<double> ozone_du = {};
  std::optional<double> ground_albedo = {};
};

/// Hold a value, or let it go.
struct HudHold {
  std::optional<double> value = {};
};

struct HudLampRequest {
  std::size_t lamp = 0;  // in HudChoices::lamps
  bool is_on = true;
};

enum class HudPictureKind { kPng, kExr };

struct HudCaptureRequest {
  HudPictureKind kind = HudPictureKind::kPng;
  int width = 0;  // pixels, [1, kLargestImageSide]
  int height = 0;
  bool with_hud = false;
};

struct HudRequest {
  std::optional<HudPlaceRequest> place = {};
  std::optional<std::string> named_place = {};  // as PlaceNamed (places.h) reads it
  HudTimeRequest time;
  HudAirRequest air;
  std::optional<HudLampRequest> lamp = {};
  std::optional<std::string> tone_curve = {};
  std::optional<std::string> look = {};
  std::optional<std::string> white_balance =
      {};  // as WhiteBalanceFromText (white_balance.h) reads it
  std::optional<bool> exposure_locked = {};
  std::optional<double> ev100 = {};  // and locked at it
  std::optional<double> compensation_ev = {};
  std::optional<std::string> quality = {};
  std::optional<std::string> mode = {};
  std::optional<double> throttle = {};  // share, [0, 1]
  std::optional<HudHold> hold_heading_rad = {};
  std::optional<HudHold> hold_height_m = {};
  std::optional<HudHold> hold_speed_m_per_s = {};
  std::optional<HudCaptureRequest> capture = {};
  std::optional<bool> record = {};  // begin or end
  std::optional<HudUnits> units = {};
  std::optional<HudThemeChoice> theme = {};  // done already by whoever drew the panel
  bool quit = false;
};

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
