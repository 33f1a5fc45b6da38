// SPDX-License-Identifier: MIT
// What was asked for in panels during one frame: each value at most once, most of the time none.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "viewer/hud/hud_model.h"
#include "viewer/hud/hud_theme.h"

namespace alpenglow::viewer {

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

}  // namespace alpenglow::viewer
