// SPDX-License-Identifier: MIT
// What happened to a window between two frames, as numbers: keys, buttons and modifiers are GLFW's.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace alpenglow::viewer
