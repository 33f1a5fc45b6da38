// SPDX-License-Identifier: MIT
// This header provides Controls, which converts the events of a window into the intent of the pilot.
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
#include <string>
#include <vector>

#include "lut/image/image.h"
#include "viewer/flight/pilot.h"
#include "viewer/input/action.h"
#include "viewer/input/window_events.h"

namespace alpenglow::viewer {

/// Input of one frame, for controls and panels.
struct InputFrame {
  WindowEvents events = {};
  ImageSize size = {};   // of the picture [pixels]; 0 while there is none
  double seconds = 0.0;  // since the last frame
};

/// Input that panels use themselves: the mouse over a panel, the keyboard while text is typed.
struct TakenByPanels {
  bool mouse = false, keyboard = false;
};

/// kCursor: a drag with the left button looks around. kLook: the mouse looks around without a
/// button. kFly: the mouse is the stick, centred on the middle of the window.
enum class MouseMode { kCursor, kLook, kFly };

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

/// Intent of the user in one frame.
struct Intent {
  PilotControls pilot;
  std::vector<const Action*> actions;  // in the order of the key presses
  std::vector<const Action*> refused;  // pressed without a picture to act on; to be reported
};

class Controls {
 public:
  /// This constructor and Set throw InputError for a dead zone not in [0, 0.9] and an expo not in
  /// [0, 1].
  explicit Controls(const ControlSettings& settings = {}) { Set(settings); }

  [[nodiscard]] MouseMode mouse_mode() const { return mouse_mode_; }
  void NextMouseMode();
  [[nodiscard]] const ControlSettings& settings() const { return settings_; }
  void Set(const ControlSettings& settings);

  /// Returns the intent of a frame. Held actions use the position of a key, all others its printed
  /// label. Looking around counts in widths of the window along both axes.
  [[nodiscard]] Intent Interpret(const InputFrame& input, FlightMode mode,
                                 const TakenByPanels& taken = {});

 private:
  struct WindowPoint {
    double right, down;  // fractions of the window
  };

  void LetGo();
  void Resolve(const KeyEvent& event, bool minimised, FlightMode mode, Intent& intent);
  [[nodiscard]] double Pushed(const HeldControl& control) const;
  void MoveControls(double seconds);
  void MoveMouse(const InputFrame& input, bool taken, PilotControls& pilot);
  void AddMouse(FlightMode mode, PilotControls& pilot) const;
  void AddGamepad(const GamepadState& gamepad, FlightMode mode, double seconds,
                  PilotControls& pilot) const;
  void PressButtons(const GamepadState& gamepad, FlightMode mode, double seconds, Intent& intent);
  void TurnWheel(FlightMode mode, Intent& intent);

  ControlSettings settings_;
  MouseMode mouse_mode_ = MouseMode::kCursor;
  std::map<int, const Action*> held_;  // key, and its action since it went down
  std::optional<WindowPoint> mouse_;
  double wheel_ = 0.0;  // steps that have not acted
  Steering camera_;
  Stick stick_;
  std::array<double, 15> button_held_s_{};
};

}  // namespace alpenglow::viewer
