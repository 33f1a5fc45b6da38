// SPDX-License-Identifier: MIT
// Input of a frame: events of keyboard, mouse and gamepad, and Controls, which converts them into
// the intent of the pilot. It needs no window: events arrive as numbers of GLFW.
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
  struct Place {
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
  std::optional<Place> mouse_;
  double wheel_ = 0.0;  // steps that have not acted
  Steering camera_;
  Stick stick_;
  std::array<double, 15> button_held_s_{};
};

}  // namespace alpenglow::viewer
