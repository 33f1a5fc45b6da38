// SPDX-License-Identifier: MIT
// Head-up display on Dear ImGui: instruments over the picture, and panels.
//
// It does not use a window: mouse and keyboard input since the last frame arrives as HudInput,
// which HudKeys collects from the GLFW keys of a window. So pictures without a display have
// instruments too, and tests can click.
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

/// Keys that edit text or navigate panels.
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
  double x = 0.0, y = 0.0;  // pixels from the upper left corner of the picture
};

struct HudInput {
  int width = 0, height = 0;               // size of the picture [pixels]
  double seconds = 0.0;                    // since the last frame
  std::optional<HudPointer> pointer = {};  // empty outside the window
  std::array<bool, 3> buttons{};  // left, right, middle: held, or clicked since the last frame
  double wheel = 0.0;             // steps, positive away from the user
  std::vector<HudKey> keys;       // held, or pressed and released since the last frame
  bool shift = false, control = false;
  std::string text;  // typed text, UTF-8
};

/// Collects the panel keys that are held, or were pressed and released since the last frame.
class HudKeys {
 public:
  /// @param glfw_key  GLFW_KEY_...; keys that panels do not use are ignored.
  /// @param is_down   false for a release; repeats count as down.
  void Note(int glfw_key, bool is_down);
  /// Releases all keys, when the window loses the keyboard.
  void Release() { held_.clear(); }

  /// Returns the input with its keys, shift and control filled in. Call once per frame.
  [[nodiscard]] HudInput Into(HudInput input);

 private:
  std::vector<int> held_;     // GLFW keys
  std::vector<int> pressed_;  // since the last frame
};

struct HudSettings {
  double scale = 1.0;  // pixels per unit, [0.5, 8]: 1 for 96 dots per inch
  HudThemeChoice theme = HudThemeChoice::kAuto;
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

  /// Lays out instruments and panels for the picture's size, applies mouse and keyboard input to
  /// them, and returns the requests of the panels. Call once per frame, before the controls move
  /// the eye.
  /// @param strip  null until it is computed.
  [[nodiscard]] HudRequest Update(const HudModel& model, const HudChoices& choices,
                                  const DayStrip* strip, const HudInput& input);

  /// Draws the layout of the last Update over a framebuffer (0: the window) of its size. Draws
  /// nothing while hidden. Leaves depth test, blending and scissor test disabled.
  void Paint(GLuint framebuffer) const;

  /// Returns whether the panels, not the flight, receive the mouse or typed text, as of the last
  /// Update.
  [[nodiscard]] bool WantsMouse() const;
  [[nodiscard]] bool WantsKeyboard() const;

  void ToggleVisible() { visible_ = !visible_; }
  [[nodiscard]] bool visible() const { return visible_; }
  void Toggle(HudPanel panel) { panels_.Toggle(panel); }
  [[nodiscard]] bool IsOpen(HudPanel panel) const { return panels_.IsOpen(panel); }
  /// Closes all panels and returns whether any was open: the key that leaves the program closes
  /// panels first.
  bool ClosePanels() { return panels_.CloseAll(); }
  void ToggleMenu() { panels_.ToggleMenu(); }

  void SetTheme(HudThemeChoice choice) { choice_ = choice; }
  [[nodiscard]] HudThemeChoice theme_choice() const { return choice_; }
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
  HudThemeChoice choice_;
  HudTheme theme_ = HudTheme::kDay;
  Panels panels_;
  bool visible_ = true;
};

}  // namespace alpenglow::viewer
