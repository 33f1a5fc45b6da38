// SPDX-License-Identifier: MIT
// What stands on each panel: draws its controls into the window of Dear ImGui that is begun and
// returns the request with what was asked for there.
#pragma once

#include <array>

#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"

namespace alpenglow::viewer {

inline constexpr double kPanelMargin = 10.0;  // to the edges of the picture [units]

/// What panels show.
struct PanelView {
  const HudModel& model;
  const HudChoices& choices;
  const DayStrip* strip;  // null until there is one
  HudTheme theme;
  HudThemeChoice theme_choice;
  double scale;       // pixels a unit
  int width, height;  // of the picture [pixels]
  int top;            // of it that panels leave free: menu and clock [pixels]
};

/// Texts and numbers that are typed before they are asked for.
struct PanelTyping {
  std::array<char, 64> instant{}, place_name{};
  std::array<double, 3> place{};  // latitude and longitude [deg], height [m]
  bool is_place_typed = false;    // else it follows the eye
  std::array<int, 2> picture_size{};
  bool is_size_typed = false;  // else it is that of the picture
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
