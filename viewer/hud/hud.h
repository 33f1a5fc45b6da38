// SPDX-License-Identifier: MIT
// Head-up display on Dear ImGui: instruments over the picture, and panels with settings and
// information.
//
// It does not use a window: the input of a frame arrives as an InputFrame. So pictures without a
// display have instruments too, and tests can click.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "viewer/gl/gl_context.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/panels.h"
#include "viewer/input/controls.h"

namespace alpenglow::viewer {

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
