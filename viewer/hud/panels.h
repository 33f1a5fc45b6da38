// SPDX-License-Identifier: MIT
// The keys, as the panel of help lists them: each action once, under the heading of its mode.
//
// Panels: what the pilot sets by mouse, and what is looked up; and the menu that opens them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "viewer/hud/panel_contents.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

/// Draws them into the window of Dear ImGui that is begun, in as many columns as fit side by side.
void ShowKeyHelp(const PanelView& view);

using HelpColumns = std::vector<std::vector<ActionSection>>;
/// The sections in their order in columns of which the longest is as short as it can be.
/// @param most_columns  >= 1.
[[nodiscard]] HelpColumns InColumns(const std::vector<ActionSection>& sections,
                                    std::size_t most_columns);

enum class HudPanel {
  kPlaceAndTime,
  kAir,
  kLights,
  kExposure,
  kFlight,
  kTables,
  kCapture,
  kHelp,
  kLeave
};
inline constexpr std::size_t kHudPanels = 9;

/// Which panels are open, and what is being typed into them. Works on the Dear ImGui context that
/// is current, between its NewFrame and Render.
class Panels {
 public:
  void Toggle(HudPanel panel) { Open(panel) = !Open(panel); }
  [[nodiscard]] bool IsOpen(HudPanel panel) const { return open_[static_cast<std::size_t>(panel)]; }
  /// Whether any was open.
  bool CloseAll();
  void ToggleMenu() { menu_ = !menu_; }
  /// Pixels that the menu takes of the upper edge.
  [[nodiscard]] int MenuHeight() const;

  [[nodiscard]] HudRequest Draw(const PanelView& view);

 private:
  bool& Open(HudPanel panel) { return open_[static_cast<std::size_t>(panel)]; }
  void DrawMenu();
  [[nodiscard]] HudRequest DrawPanel(HudPanel panel, const PanelView& view, HudRequest request);
  [[nodiscard]] HudRequest Contents(HudPanel panel, const PanelView& view, HudRequest request);

  std::array<bool, kHudPanels> open_{};
  std::array<int, kHudPanels> frames_{};  // since it appeared
  bool menu_ = false;
  PanelTyping typing_;
  std::array<int, 2> picture_{};  // size of the last one [pixels]
  bool resized_ = false;          // since the last frame: panels are placed anew
};

}  // namespace alpenglow::viewer
