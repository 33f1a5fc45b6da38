// SPDX-License-Identifier: MIT
// Contents of each panel: functions that draw its controls into the current Dear ImGui window and
// make the changes that the user requests.
#pragma once

#include <array>

#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

inline constexpr double kPanelMargin = 10.0;  // to the edges of the picture [units]

/// State that panels show.
struct PanelView {
  const HudModel& model;
  const DayStrip* strip;  // null until it is computed
  HudTheme theme;
  double scale;       // pixels per unit
  int width, height;  // of the picture [pixels]
  int top;            // height at the upper edge that panels avoid: menu and clock [pixels]
};

/// State that panels show, and what they change.
struct PanelChange {
  const PanelView& view;
  HudPreferences& preferences;
  FlightCommands& flight;
};

/// Typed texts and numbers before they are submitted.
struct PanelTyping {
  std::array<char, 64> instant{}, place_name{};
  std::array<double, 3> place{};  // latitude and longitude [deg], height [m]
  bool is_place_typed = false;    // false: the fields follow the eye
  std::array<int, 2> picture_size{};
  bool is_size_typed = false;  // false: the size of the picture
  bool with_hud = false;
};

void DrawPlaceAndTime(const PanelChange& change, PanelTyping& typing);
void DrawAir(const PanelChange& change);
void DrawWeather(const PanelChange& change);
void DrawLights(const PanelChange& change);
void DrawExposure(const PanelChange& change);
void DrawFlight(const PanelChange& change);
void DrawTables(const PanelChange& change);
void DrawCapture(const PanelChange& change, PanelTyping& typing);

}  // namespace alpenglow::viewer
