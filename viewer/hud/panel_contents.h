// SPDX-License-Identifier: MIT
// Contents of each panel: functions that draw its controls into the current Dear ImGui window and
// return the request with the user's changes.
#pragma once

#include <array>

#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"

namespace alpenglow::viewer {

inline constexpr double kPanelMargin = 10.0;  // to the edges of the picture [units]

/// State that panels show.
struct PanelView {
  const HudModel& model;
  const HudChoices& choices;
  const DayStrip* strip;  // null until it is computed
  HudTheme theme;
  HudThemeChoice theme_choice;
  double scale;       // pixels per unit
  int width, height;  // of the picture [pixels]
  int top;            // height at the upper edge that panels avoid: menu and clock [pixels]
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

[[nodiscard]] HudRequest WithPlaceAndTime(const PanelView& view, PanelTyping& typing,
                                          HudRequest request);
[[nodiscard]] HudRequest WithAir(const PanelView& view, HudRequest request);
[[nodiscard]] HudRequest WithLights(const PanelView& view, HudRequest request);
[[nodiscard]] HudRequest WithExposure(const PanelView& view, HudRequest request);
[[nodiscard]] HudRequest WithFlight(const PanelView& view, HudRequest request);
[[nodiscard]] HudRequest WithTables(const PanelView& view, HudRequest request);
[[nodiscard]] HudRequest WithCapture(const PanelView& view, PanelTyping& typing,
                                     HudRequest request);

}  // namespace alpenglow::viewer
