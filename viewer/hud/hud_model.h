// SPDX-License-Identifier: MIT
// All that instruments and panels show of one moment: plain values, filled anew for every frame.
//
// Angles in radians, azimuths and headings clockwise from north, heights and speeds in SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace alpenglow::viewer {

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

}  // namespace alpenglow::viewer
