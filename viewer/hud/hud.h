// SPDX-License-Identifier: MIT
// What mouse and keyboard did since the last frame, as panels want it: no window is needed for it.
//
// Keys of a window, as GLFW numbers them, gathered for panels.
//
// Head-up display: instruments over the picture, and panels. Dear ImGui underneath.
//
// Knows no window: what mouse and keyboard did comes as HudInput, so that pictures without a
// display have instruments too, and tests click.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"
#include "viewer/hud/panels.h"

namespace alpenglow::viewer {

/// Keys that edit text or walk through panels.
enum class HudKey {
  kTab,
  kLeft,
  kRight,
  kUp,
  kDown,
  kPageUp,
  kPageDown,
  kHome,
  kEnd,
  kInsert,
  kDelete,
  kBackspace,
  kSpace,
  kEnter,
  kEscape,
  kA,
  kC,
  kV,
  kX,
  kY,
  kZ
};

struct HudPointer {
  double x = 0.0, y = 0.0;  // pixels of the picture from its upper left corner
};

struct HudInput {
  int width = 0, height = 0;               // of the picture [pixels]
  double seconds = 0.0;                    // since the last frame
  std::optional<HudPointer> pointer = {};  // none outside of the window
  std::array<bool, 3> buttons{};           // left, right, middle: held, or pressed and let go
  double wheel = 0.0;                      // steps, away from who turns it
  std::vector<HudKey> keys;                // held, or pressed and let go
  bool shift = false, control = false;
  std::string text;  // typed, UTF-8
};

/// Which of the keys that panels know are held, or were pressed and let go since the last frame.
class HudKeys {
 public:
  /// @param glfw_key  GLFW_KEY_...; others than panels know are passed over.
  /// @param is_down   false when it was let go; repeats count as down.
  void Note(int glfw_key, bool is_down);
  /// All keys are up: the window no longer hears the keyboard.
  void Release() { held_.clear(); }

  /// Once a frame: the input with its keys, shift and control filled in.
  [[nodiscard]] HudInput Into(HudInput input);

 private:
  std::vector<int> held_;     // of GLFW
  std::vector<int> pressed_;  // since the last frame
};

struct HudSettings {
  double scale = 1.0;  // pixels a unit, [0.5, 8]: 1 for 96 dots an inch
  HudThemeChoice theme = HudThemeChoice::kAuto;
  std::optional<std::filesystem::path> font = {};  // TrueType; else InstalledFont (imgui_backend.h)
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
