// SPDX-License-Identifier: MIT
// This header provides the events of keyboard, mouse and gamepad between two frames, with the
// numbers of GLFW. It needs no window.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::viewer {

/// A key that went up (0), went down (1) or repeats (2).
struct KeyEvent {
  int key = -1;  // position on an American keyboard; -1: unknown
  int scancode = 0;
  int change = 0;
  int modifiers = 0;         // Shift 1, Ctrl 2, Alt 4, Super 8
  std::string printed = {};  // printed on this keyboard: "w"; empty for Esc and similar keys
};

/// Position in pixels from the upper left corner of the picture. It may be fractional on displays
/// whose desktop units are larger than pixels. It may be outside of the picture while a button is
/// held or the pointer is captured.
struct PointerPlace {
  double right = 0.0, down = 0.0;
};

/// A gamepad in the layout of an Xbox controller, as mapped by GLFW's gamepad table
/// (GLFWgamepadstate). Axes: left stick right and down, right stick right and down, from -1 to 1;
/// left and right trigger, from -1 (released) to 1.
struct GamepadState {
  std::string name = {};
  std::array<unsigned char, 15> buttons{};
  std::array<float, 6> axes{0.0F, 0.0F, 0.0F, 0.0F, -1.0F, -1.0F};
};

/// Events of a window between two frames.
struct WindowEvents {
  std::vector<KeyEvent> keys;           // in the order of their occurrence
  std::string text;                     // typed, UTF-8
  std::optional<PointerPlace> pointer;  // nullopt outside of the window
  std::array<bool, 3> buttons{};        // left, right, middle: held, or pressed and released
  double wheel = 0.0;                   // steps, positive away from the user
  std::optional<GamepadState> gamepad;
  bool focused = true;     // has the keyboard focus
  bool minimised = false;  // the window is not visible
  bool close = false;      // closing was requested

  /// Returns whether the keyboard acts on the flight.
  [[nodiscard]] bool HasKeyboard() const { return focused && !minimised; }
};

}  // namespace alpenglow::viewer
