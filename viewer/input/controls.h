// SPDX-License-Identifier: MIT
// Keyboard, mouse and gamepad, from their events to what is asked for in a frame. No window is
// needed: events come in as numbers.
//
// Held keys move a control like a hand does, in a quarter of a second from rest to its end and back.
// A window that is not looked at flies on and hears nothing: while it is minimised, or another has
// the keyboard, nothing is held, gamepads too, and controls go back to their middle; of what was pressed while it is
// minimised, that which needs a picture is refused and said, movement is forgotten, and switches
// (pause, autopilot, quit...) act at once. Nothing waits to act later.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "viewer/flight/pilot.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

/// A drag with the left button looks around (kCursor); the mouse looks around without a button
/// (kLook); the mouse is the stick, its middle the window's (kFly).
enum class MouseMode { kCursor, kLook, kFly };

/// A gamepad as GLFW maps it (GLFWgamepadstate): sticks in [-1, 1], down and right positive;
/// triggers from -1, released, to 1.
struct GamepadState {
  std::array<unsigned char, 15> buttons{};
  std::array<float, 6> axes{0.0F, 0.0F, 0.0F, 0.0F, -1.0F, -1.0F};
};

struct ControlSettings {
  double dead_zone = 0.12;     // of a stick's way that does nothing, in [0, 0.9]
  double expo = 0.5;           // in [0, 1]: 0 is linear, 1 is the cube
  bool invert_y = false;       // stick and mouse pushed forward lift the nose
  bool invert_look_y = false;  // looking around: forward looks down
};

/// A stick's place with its dead zone cut out of the middle, by its distance from it, and the rest
/// stretched to [0, 1] and bent: (1 - expo) d + expo d^3. The direction stays.
struct StickPlace {
  double right, down;
};
[[nodiscard]] StickPlace Shaped(const StickPlace& raw, const ControlSettings& settings);

/// A control that a hand moves: nearer to where it is pushed, `per_second` of its way at most.
[[nodiscard]] double MovedToward(double value, double target, double per_second, double seconds);

/// What happened in a frame.
struct Intent {
  PilotControls pilot;
  std::vector<Action> actions;  // in the order of the key presses
  std::vector<Action> refused;  // pressed without a picture to act on; to be said
};

class Controls {
 public:
  /// Throws InputError, here and in Set, for a dead zone not in [0, 0.9] and an expo not in [0, 1].
  explicit Controls(const ControlSettings& settings = {}) { Set(settings); }

  /// @param change     GLFW_RELEASE, GLFW_PRESS or GLFW_REPEAT (0, 1, 2)
  /// @param modifiers  GLFW_MOD_SHIFT and so on
  /// @param printed    PrintedKey: what is held goes by the place of the key, the rest by what is
  ///                   printed on it
  void Key(int key, int change, int modifiers, int printed);
  void Key(int key, int change, int modifiers) { Key(key, change, modifiers, key); }
  /// The mouse's place in the window, from 0 to 1 to the right and down.
  /// @param width_to_height  of the window: looking around counts in widths both ways
  void MouseAt(double right, double down, double width_to_height);
  void MouseButton(bool left_is_down) { dragging_ = left_is_down; }
  /// Steps of the wheel, forward positive.
  void Wheel(double steps) { wheel_ += steps; }
  /// The instruments under the cursor took the mouse or the keyboard for themselves.
  void IgnoreMouse(bool ignored) { mouse_is_ignored_ = ignored; }
  /// Whether this window has the keyboard, and whether it is minimised; as often as one likes.
  void Focus(bool focused);
  void Minimise(bool minimised);

  [[nodiscard]] MouseMode mouse_mode() const { return mouse_mode_; }
  [[nodiscard]] const ControlSettings& settings() const { return settings_; }
  void Set(const ControlSettings& settings);

  /// What is asked for since the last call, `seconds` ago. kMouseMode is done here and told too.
  [[nodiscard]] Intent Take(FlightMode mode, double seconds,
                            const std::optional<GamepadState>& gamepad = {});

 private:
  struct KeyEvent {
    int key, change, modifiers, printed;
    bool minimised;
  };
  struct Place {
    double right, down;
  };

  void LetGo();
  void Resolve(const KeyEvent& event, FlightMode mode, Intent& intent);
  void Ask(Action action, Intent& intent);
  [[nodiscard]] double Pushed(Action positive, Action negative) const;
  void MoveControls(double seconds);
  void AddMouse(FlightMode mode, PilotControls& pilot) const;
  void AddGamepad(const GamepadState& gamepad, FlightMode mode, double seconds,
                  PilotControls& pilot) const;
  void PressButtons(const GamepadState& gamepad, FlightMode mode, double seconds, Intent& intent);
  void TurnWheel(FlightMode mode, Intent& intent);

  ControlSettings settings_;
  MouseMode mouse_mode_ = MouseMode::kCursor;
  std::vector<KeyEvent> events_;
  std::map<int, Action> held_;  // key and what it does since it went down
  std::optional<Place> mouse_;
  bool dragging_ = false, focused_ = true, minimised_ = false, mouse_is_ignored_ = false;
  double wheel_ = 0.0, look_right_ = 0.0, look_up_ = 0.0;
  Steering camera_;
  Stick stick_;
  std::array<double, 15> button_held_s_{};
};

}  // namespace alpenglow::viewer
