// SPDX-License-Identifier: MIT
// The panels of the head-up display, and the menu that opens them.
#pragma once

#include <array>
#include <cstddef>

#include "viewer/hud/panel_contents.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

enum class HudPanel {
  kPlaceAndTime,
  kAir,
  kWeather,
  kLights,
  kExposure,
  kFlight,
  kTables,
  kCapture,
  kHelp,
  kLeave
};
inline constexpr std::size_t kHudPanels = 10;

/// Open panels, and the text being typed into them. Uses the current Dear ImGui context, between
/// its NewFrame and Render.
class Panels {
 public:
  void Toggle(HudPanel panel) { Open(panel) = !Open(panel); }
  [[nodiscard]] bool IsOpen(HudPanel panel) const { return open_[static_cast<std::size_t>(panel)]; }
  /// Closes all panels and returns whether any was open.
  bool CloseAll();
  void ToggleMenu() { menu_ = !menu_; }
  /// Returns the height of the menu at the upper edge [pixels].
  [[nodiscard]] int MenuHeight() const;

  /// Draws the open panels, which change the flight and the preferences.
  void Draw(const PanelView& view, HudPreferences& preferences, FlightCommands& flight);

 private:
  bool& Open(HudPanel panel) { return open_[static_cast<std::size_t>(panel)]; }
  void DrawMenu();
  void DrawPanel(HudPanel panel, const PanelChange& change);
  void DrawContents(HudPanel panel, const PanelChange& change);

  std::array<bool, kHudPanels> open_{};
  std::array<int, kHudPanels> frames_{};  // since the panel appeared
  bool menu_ = false;
  PanelTyping typing_;
  std::array<int, 2> picture_{};  // size of the last picture [pixels]
  bool resized_ = false;          // since the last frame: panels are placed again
};

}  // namespace alpenglow::viewer
