// SPDX-License-Identifier: MIT
// Head-up display: instruments over the picture, and panels. Dear ImGui underneath.
//
// Knows no window: what mouse and keyboard did comes as HudInput, so that pictures without a
// display have instruments too, and tests click.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "viewer/gl/gl_objects.h"
#include "viewer/hud/day_strip.h"
#include "viewer/hud/hud_input.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/hud_request.h"
#include "viewer/hud/hud_theme.h"
#include "viewer/hud/panels.h"

namespace alpenglow::viewer {

struct HudSettings {
  double scale = 1.0;  // pixels a unit, [0.5, 8]: 1 for 96 dots an inch
  HudThemeChoice theme = HudThemeChoice::kAuto;
  std::optional<std::filesystem::path> font = {};  // TrueType; else InstalledFont (hud_font.h)
};

/// For pictures of other sizes than the window's: another Hud, so that panels stay where they are.
class Hud {
 public:
  /// An OpenGL context must be current, now and in all calls. Throws InputError for a scale out of
  /// range and a font that is none.
  explicit Hud(const HudSettings& settings = {});
  ~Hud();
  Hud(const Hud&) = delete;
  Hud& operator=(const Hud&) = delete;

  /// Lays out instruments and panels for the picture's size, lets mouse and keyboard work on them,
  /// and says what was asked for. Once a frame, before what was steered moves the eye.
  /// @param strip  null until there is one.
  [[nodiscard]] HudRequest Update(const HudModel& model, const HudChoices& choices,
                                  const DayStrip* strip, const HudInput& input);

  /// Draws what the last Update laid out over a framebuffer (0: the window) of its size. Nothing
  /// while hidden. No depth test, blending or scissor test is left on.
  void Paint(GLuint framebuffer) const;

  /// Whether, since the last Update, mouse or typing are the panels' and not the flight's.
  [[nodiscard]] bool WantsMouse() const;
  [[nodiscard]] bool WantsKeyboard() const;

  void ToggleVisible() { visible_ = !visible_; }
  [[nodiscard]] bool visible() const { return visible_; }
  void Toggle(HudPanel panel) { panels_.Toggle(panel); }
  [[nodiscard]] bool IsOpen(HudPanel panel) const { return panels_.IsOpen(panel); }
  /// Whether any was open: the key that leaves the program closes panels first.
  bool ClosePanels() { return panels_.CloseAll(); }
  void ToggleMenu() { panels_.ToggleMenu(); }

  void SetTheme(HudThemeChoice choice) { choice_ = choice; }
  [[nodiscard]] HudThemeChoice theme_choice() const { return choice_; }
  [[nodiscard]] HudTheme theme() const { return theme_; }
  /// Another display: letters are made anew. Throws InputError for a scale out of range.
  void SetScale(double scale);
  [[nodiscard]] double scale() const { return scale_; }

 private:
  struct State;
  void ApplyTheme(HudTheme theme);

  std::unique_ptr<State> state_;
  std::optional<std::filesystem::path> font_;
  double scale_ = 1.0;
  HudThemeChoice choice_;
  HudTheme theme_ = HudTheme::kDay;
  Panels panels_;
  bool visible_ = true;
};

}  // namespace alpenglow::viewer
