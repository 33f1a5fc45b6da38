// SPDX-License-Identifier: MIT
// Converts events of keyboard, mouse and gamepad into the intent of a frame. It needs no window:
// events arrive as numbers.
//
// Held keys move a control like a hand does, in a quarter of a second from rest to its end and
// back. An unfocused window continues to fly without input: while it is minimised, or another
// window has the keyboard, no key, button or gamepad control is held, and controls return to their
// middle. Of the keys pressed while it is minimised, actions that need a picture are refused with a
// message, movement is dropped, and switches (pause, autopilot, quit...) act at once. No input is
// queued for later.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "viewer/flight/pilot.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

/// kCursor: a drag with the left button looks around. kLook: the mouse looks around without a
/// button. kFly: the mouse is the stick, centred on the middle of the window.
enum class MouseMode { kCursor, kLook, kFly };

/// A gamepad in GLFW's mapping (GLFWgamepadstate): sticks in [-1, 1], down and right positive;
/// triggers from -1, released, to 1.
struct GamepadState {
  std::array<unsigned char, 15> buttons{};
  std::array<float, 6> axes{0.0F, 0.0F, 0.0F, 0.0F, -1.0F, -1.0F};
};

struct ControlSettings {
  double dead_zone = 0.12;     // inactive fraction of a stick's range, in [0, 0.9]
  double expo = 0.5;           // in [0, 1]: 0 is linear, 1 is cubic
  bool invert_y = false;       // pushing stick or mouse forward lifts the nose
  bool invert_look_y = false;  // looking around: pushing forward looks down
};

/// The position of a stick. Shaped() removes a dead zone around the middle, by distance from it,
/// and stretches the remaining distance d to [0, 1] with the curve (1 - expo) d + expo d^3. The
/// direction is unchanged.
struct StickPlace {
  double right, down;
};
[[nodiscard]] StickPlace Shaped(const StickPlace& raw, const ControlSettings& settings);

/// Returns the value of a control moved by a hand: it approaches `target` by at most `per_second`
/// of its range per second.
[[nodiscard]] double MovedToward(double value, double target, double per_second, double seconds);

/// Input of one frame.
struct Intent {
  PilotControls pilot;
  std::vector<Action> actions;  // in the order of the key presses
  std::vector<Action> refused;  // pressed without a picture to act on; to be reported
};

class Controls {
 public:
  /// This constructor and Set throw InputError for a dead zone not in [0, 0.9] and an expo not in
  /// [0, 1].
  explicit Controls(const ControlSettings& settings = {}) { Set(settings); }

  /// @param change     GLFW_RELEASE, GLFW_PRESS or GLFW_REPEAT (0, 1, 2)
  /// @param modifiers  GLFW_MOD_SHIFT and so on
  /// @param printed    PrintedKey: held actions use the position of the key, all others its printed
  ///     label
  void Key(int key, int change, int modifiers, int printed);
  void Key(int key, int change, int modifiers) { Key(key, change, modifiers, key); }
  /// Sets the position of the mouse in the window, from 0 to 1 to the right and down.
  /// @param width_to_height  aspect ratio of the window: looking around counts in widths along both
  ///     axes
  void MouseAt(double right, double down, double width_to_height);
  void MouseButton(bool left_is_down) { dragging_ = left_is_down; }
  /// Adds steps of the wheel, forward positive.
  void Wheel(double steps) { wheel_ += steps; }
  /// Ignores the mouse while instruments under the cursor use it.
  void IgnoreMouse(bool ignored) { mouse_is_ignored_ = ignored; }
  /// Set whether this window has the keyboard, and whether it is minimised; repeated calls are
  /// harmless.
  void Focus(bool focused);
  void Minimise(bool minimised);

  [[nodiscard]] MouseMode mouse_mode() const { return mouse_mode_; }
  [[nodiscard]] const ControlSettings& settings() const { return settings_; }
  void Set(const ControlSettings& settings);

  /// Returns the input since the last call, `seconds` ago. kMouseMode is applied here and also
  /// returned.
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
  std::map<int, Action> held_;  // key, and its action since it went down
  std::optional<Place> mouse_;
  bool dragging_ = false, focused_ = true, minimised_ = false, mouse_is_ignored_ = false;
  double wheel_ = 0.0, look_right_ = 0.0, look_up_ = 0.0;
  Steering camera_;
  Stick stick_;
  std::array<double, 15> button_held_s_{};
};

}  // namespace alpenglow::viewer
