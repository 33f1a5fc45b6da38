// SPDX-License-Identifier: MIT
// Hands on keyboard, mouse and gamepad: their events since the last frame, and the controls.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "viewer/input/controls.h"

namespace alpenglow::tests {

using namespace viewer;

class Hands {
 public:
  explicit Hands(const ControlSettings& settings = {}) : controls(settings) {}

  void Key(int key, int change, int modifiers, int printed) {
    const bool has_label = printed > 32 && printed < 128;
    input_.events.keys.push_back(
        {key, 0, change, modifiers, has_label ? std::string(1, static_cast<char>(printed)) : ""});
  }
  void Key(int key, int change, int modifiers) { Key(key, change, modifiers, key); }
  /// Fractions of a window of this aspect ratio.
  void MouseAt(double right, double down, double width_to_height) {
    input_.size = {static_cast<int>(1000.0 * width_to_height), 1000};
    input_.events.pointer = PointerPlace{right * input_.size.width, down * input_.size.height};
  }
  void MouseButton(bool left_is_down) { input_.events.buttons[0] = left_is_down; }
  void Wheel(double steps) { input_.events.wheel += steps; }
  void IgnoreMouse(bool ignored) { taken_.mouse = ignored; }
  void Focus(bool focused) { input_.events.focused = focused; }
  void Minimise(bool minimised) { input_.events.minimised = minimised; }

  /// A frame with all that happened since the last one.
  Intent Interpret(FlightMode mode, double seconds,
                   const std::optional<GamepadState>& gamepad = {}) {
    input_.seconds = seconds;
    input_.events.gamepad = gamepad;
    Intent intent = controls.Interpret(input_, mode, taken_);
    input_.events.keys.clear();
    input_.events.wheel = 0.0;
    return intent;
  }

  Controls controls;

 private:
  InputFrame input_;
  TakenByPanels taken_;
};

/// The keys of actions: "P".
inline std::vector<std::string_view> KeysOf(const std::vector<const Action*>& actions) {
  std::vector<std::string_view> keys;
  for (const Action* action : actions) keys.push_back(action->keys);
  return keys;
}

}  // namespace alpenglow::tests
