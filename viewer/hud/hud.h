// SPDX-License-Identifier: MIT
// Head-up display on Dear ImGui: instruments over the picture; panels with settings and
// information, the menu that opens them, and the help panel with the keys: each action once, under
// the heading of its mode.
//
// It does not use a window: the input of a frame arrives as an InputFrame. So pictures without a
// display have instruments too, and tests can click.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "viewer/gl/gl_context.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_contents.h"
#include "viewer/hud/panel_controls.h"
#include "viewer/input/action.h"
#include "viewer/input/controls.h"

namespace alpenglow::viewer {

/// Draws the keys into the current Dear ImGui window, in as many columns as fit side by side.
void ShowKeyHelp(const PanelView& view);

using HelpColumns = std::vector<std::vector<ActionSection>>;
/// Returns the sections in their order, in columns with the smallest possible maximum length.
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

struct HudSettings {
  double scale = 1.0;  // pixels per unit, [0.5, 8]: 1 for 96 dots per inch
  HudPreferences preferences = {};
  std::optional<std::filesystem::path> font =
      {};  // TrueType; default: InstalledFont (imgui_backend.h)
};

/// Head-up display of one picture size. Pictures of other sizes than the window's use another Hud,
/// so that panels keep their places.
class Hud {
 public:
  /// An OpenGL context must be current, now and in all calls. Throws InputError for a scale out of
  /// range and a file that is not a font.
  explicit Hud(const HudSettings& settings = {});
  ~Hud();
  Hud(const Hud&) = delete;
  Hud& operator=(const Hud&) = delete;

  /// Lays out instruments and panels for the picture's size and applies the input to the panels,
  /// which change the flight. Call once per frame, before the controls move the eye.
  /// @param strip  null until it is computed.
  void Update(const HudModel& model, const DayStrip* strip, const InputFrame& input,
              FlightCommands& flight);

  /// Draws the layout of the last Update over a framebuffer (0: the window) of its size. Draws
  /// nothing while hidden. Leaves depth test, blending and scissor test disabled.
  void Paint(GLuint framebuffer) const;

  /// Returns the input that the panels use instead of the flight, as of the last Update.
  [[nodiscard]] TakenByPanels Taken() const;

  void ToggleVisible() { visible_ = !visible_; }
  [[nodiscard]] bool visible() const { return visible_; }
  void Toggle(HudPanel panel) { panels_.Toggle(panel); }
  [[nodiscard]] bool IsOpen(HudPanel panel) const { return panels_.IsOpen(panel); }
  /// Closes all panels and returns whether any was open: the key that leaves the program closes
  /// panels first.
  bool ClosePanels() { return panels_.CloseAll(); }
  void ToggleMenu() { panels_.ToggleMenu(); }

  void SetTheme(HudThemeChoice choice) { preferences_.theme = choice; }
  [[nodiscard]] const HudPreferences& preferences() const { return preferences_; }
  [[nodiscard]] HudTheme theme() const { return theme_; }
  /// Changes the scale for another display; glyphs are rasterised anew. Throws InputError for a
  /// scale out of range.
  void SetScale(double scale);
  [[nodiscard]] double scale() const { return scale_; }

 private:
  struct State;
  void ApplyTheme(HudTheme theme);

  std::unique_ptr<State> state_;
  std::optional<std::filesystem::path> font_;
  double scale_ = 1.0;
  HudPreferences preferences_;
  HudTheme theme_ = HudTheme::kDay;
  Panels panels_;
  bool visible_ = true;
};

}  // namespace alpenglow::viewer
