// SPDX-License-Identifier: MIT
// Provides the window of skyview: an OpenGL core context on the screen, its icon, and the events of
// keyboard, mouse and gamepad between two frames. Keys, buttons and modifiers have the numbers of
// GLFW.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/input/controls.h"

namespace alpenglow::viewer {

/// A key that went up (0), went down (1) or repeats (2).
struct KeyEvent {
  int key = -1;  // position on an American keyboard; -1: unknown
  int scancode = 0;
  int change = 0;
  int modifiers = 0;    // Shift 1, Ctrl 2, Alt 4, Super 8
  std::string printed;  // printed on this keyboard: "w"; empty for Esc and similar keys
};

/// Position in pixels from the upper left corner of the picture. It may be fractional on displays
/// whose desktop units are larger than pixels. It may be outside of the picture while a button is
/// held or the pointer is captured.
struct PointerPlace {
  double right = 0.0, down = 0.0;
};

/// A gamepad in the layout of an Xbox controller, as mapped by GLFW's gamepad table. Axes: left
/// stick right and down, right stick right and down, from -1 to 1; left and right trigger, from -1
/// (released) to 1.
struct GamepadReading {
  std::string name;
  std::array<unsigned char, 15> buttons{};
  std::array<float, 6> axes{};
};

struct WindowEvents {
  std::vector<KeyEvent> keys;           // in the order of their occurrence
  std::string text;                     // typed, UTF-8
  std::optional<PointerPlace> pointer;  // nullopt outside of the window
  std::array<bool, 3> buttons{};        // left, right, middle: held, or pressed and released
  double wheel = 0.0;                   // steps, positive away from the user
  std::optional<GamepadReading> gamepad;
  bool focused = true;     // has the keyboard focus
  bool minimised = false;  // the window is not visible
  bool close = false;      // closing was requested
};

/// Input that panels use themselves: the mouse over a panel, the keyboard while text is typed.
struct TakenByPanels {
  bool mouse = false, keyboard = false;
};

/// Forwards the events of the window to the controls.
/// @param width, height  of the picture [pixels]
inline void Tell(const WindowEvents& events, int width, int height, const TakenByPanels& taken,
                 Controls& controls) {
  controls.Minimise(events.minimised);
  controls.Focus(events.focused || events.minimised);
  for (const KeyEvent& key : events.keys) {
    // Releases of keys are always forwarded.
    if (taken.keyboard && key.change != 0) continue;
    controls.Key(key.key, key.change, key.modifiers, PrintedKey(key.key, key.printed.c_str()));
  }
  controls.IgnoreMouse(taken.mouse);
  controls.MouseButton(events.buttons[0]);
  if (events.pointer && width > 0 && height > 0) {
    controls.MouseAt(events.pointer->right / width, events.pointer->down / height,
                     static_cast<double>(width) / height);
  }
  controls.Wheel(events.wheel);
}

[[nodiscard]] inline std::optional<GamepadState> GamepadOf(const WindowEvents& events) {
  if (!events.gamepad) return std::nullopt;
  return GamepadState{events.gamepad->buttons, events.gamepad->axes};
}

/// Returns the icon of the window, a peak at sunset: side x side pixels with red, green, blue and
/// alpha of one byte each; row 0 is the top. side >= 1.
[[nodiscard]] std::vector<std::uint8_t> WindowIcon(int side);

/// Initial state of a window.
struct WindowSettings {
  int width = 1280, height = 720;  // of the picture [pixels], if the desktop allows it
  bool fullscreen = false;
  bool vsync = true;  // Swap waits for the display
};

/// The window. Only one can exist at a time.
class Window {
 public:
  /// Creates the window and makes its context current on this thread. Throws DisplayError if there
  /// is no display or its OpenGL is older than 3.3.
  explicit Window(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns the events since the last call. While the window is not visible, it waits at most a
  /// tenth of a second, so that a minimised flight uses no processor time and still reacts to
  /// signals.
  [[nodiscard]] WindowEvents Poll();

  [[nodiscard]] int width() const;  // of the picture [pixels]; 0 while there is no picture
  [[nodiscard]] int height() const;
  /// Returns the number of pixels per unit of 1/96 inch, as set by the desktop.
  [[nodiscard]] double content_scale() const;

  [[nodiscard]] bool fullscreen() const;
  /// Switches to full screen on the monitor that contains the centre of the window, or back to the
  /// previous position.
  void SetFullscreen(bool fullscreen);
  void SetVsync(bool vsync);
  /// Hides the pointer and lets it move without limits, to look around.
  void CapturePointer(bool captured);

  /// Displays the drawn picture. Throws DisplayError if the GPU was reset (RequireContext).
  void Swap();

  /// Sets a function that is called before the program ends with status 5 because the display is
  /// lost (Xlib then ends the program). It should only close files. Its exceptions are written to
  /// standard error.
  void AtLostDisplay(std::function<void()> last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::viewer
