// SPDX-License-Identifier: MIT
// What happened to a window between two frames, as numbers: keys, buttons and modifiers are GLFW's.
//
// What happened to a window, told to the controls.
//
// The icon of the window: a peak in the last light.
//
// The window: an OpenGL core context on the screen, and what keyboard, mouse and gamepad do.
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
  int key = -1;  // by its place on an American keyboard; -1: unknown
  int scancode = 0;
  int change = 0;
  int modifiers = 0;    // Shift 1, Ctrl 2, Alt 4, Super 8
  std::string printed;  // what this keyboard has on it: "w"; empty for Esc and the like
};

/// Pixels of the picture from its upper left corner; between pixels on displays whose windows count
/// in larger units. Outside of the picture while a button is held, or the pointer captured.
struct PointerPlace {
  double right = 0.0, down = 0.0;
};

/// A gamepad in the layout of an Xbox controller, as GLFW's table of gamepads maps it. Axes: left
/// stick right and down, right stick right and down, from -1 to 1; left and right trigger, from -1
/// (released) to 1.
struct GamepadReading {
  std::string name;
  std::array<unsigned char, 15> buttons{};
  std::array<float, 6> axes{};
};

struct WindowEvents {
  std::vector<KeyEvent> keys;           // in the order they happened
  std::string text;                     // typed, UTF-8
  std::optional<PointerPlace> pointer;  // none outside of the window
  std::array<bool, 3> buttons{};        // left, right, middle: held, or pressed and let go
  double wheel = 0.0;                   // steps, away from who turns it
  std::optional<GamepadReading> gamepad;
  bool focused = true;     // hears the keyboard
  bool minimised = false;  // nothing is seen of it
  bool close = false;      // was asked to
};

/// What the panels under the pointer, or the text that is being typed, keep for themselves.
struct TakenByPanels {
  bool mouse = false, keyboard = false;
};

/// @param width, height  of the picture [pixels]
inline void Tell(const WindowEvents& events, int width, int height, const TakenByPanels& taken,
                 Controls& controls) {
  controls.Minimise(events.minimised);
  controls.Focus(events.focused || events.minimised);
  for (const KeyEvent& key : events.keys) {
    // What goes up is heard in any case.
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

/// side x side pixels, red, green, blue and alpha of a byte each, row 0 at the top. side >= 1.
[[nodiscard]] std::vector<std::uint8_t> WindowIcon(int side);

/// Where a window begins.
struct WindowSettings {
  int width = 1280, height = 720;  // of the picture [pixels], where the desktop lets it
  bool fullscreen = false;
  bool vsync = true;  // Swap waits for the display
};

/// One at a time.
class Window {
 public:
  /// Its context is current on this thread from here on. Throws DisplayError when there is no
  /// display or its OpenGL is older than 3.3.
  explicit Window(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// What has happened since the last call. While nothing of the window is seen, waits for a tenth
  /// of a second at most, so that a minimised flight costs nothing and signals are heard.
  [[nodiscard]] WindowEvents Poll();

  [[nodiscard]] int width() const;  // of the picture [pixels]; 0 while it has none
  [[nodiscard]] int height() const;
  /// Pixels for a unit of 1/96 inch, as the desktop has it.
  [[nodiscard]] double content_scale() const;

  [[nodiscard]] bool fullscreen() const;
  /// On the screen that the window's middle is on; back to where the window was.
  void SetFullscreen(bool fullscreen);
  void SetVsync(bool vsync);
  /// Hides the pointer and lets it move without end, to look around.
  void CapturePointer(bool captured);

  /// Shows what was drawn. Throws DisplayError when the graphics card was reset (RequireContext).
  void Swap();

  /// What is done before the program ends with status 5 because the display itself has gone (Xlib
  /// ends programs then): no more than to close files. Exceptions are said.
  void AtLostDisplay(std::function<void()> last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::viewer
