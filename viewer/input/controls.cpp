// SPDX-License-Identifier: MIT
#include "viewer/input/controls.h"

// GLFW is included for its button and axis numbers alone.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "atmosphere/base/error.h"

namespace alpenglow::viewer {
namespace {

static_assert(sizeof(GamepadState::buttons) == sizeof(GLFWgamepadstate::buttons) &&
              sizeof(GamepadState::axes) == sizeof(GLFWgamepadstate::axes));

constexpr double kHandPerSecond = 4.0;

double Within(double value) { return std::clamp(value, -1.0, 1.0); }

double AxisOf(const GamepadState& gamepad, int axis) {
  return gamepad.axes[static_cast<std::size_t>(axis)];
}
bool IsDown(const GamepadState& gamepad, int button) {
  return gamepad.buttons[static_cast<std::size_t>(button)] == GLFW_PRESS;
}
/// Returns 0 for a released trigger, 1 for a pulled one.
double TriggerOf(const GamepadState& gamepad, int axis) {
  return std::clamp(0.5 + 0.5 * AxisOf(gamepad, axis), 0.0, 1.0);
}

void Perform(const Action& action, bool minimised, Intent& intent) {
  (action.needs_picture && minimised ? intent.refused : intent.actions).push_back(&action);
}

/// Returns how many times a button held for `held_s` has acted so far.
int TimesActed(double held_s) {
  constexpr double kDelay_s = 0.4, kEvery_s = 0.1;
  return held_s < kDelay_s ? 1 : 2 + static_cast<int>((held_s - kDelay_s) / kEvery_s);
}

}  // namespace

StickPlace Shaped(const StickPlace& raw, const ControlSettings& settings) {
  const double distance = std::hypot(raw.right, raw.down);
  if (distance <= settings.dead_zone) return {0.0, 0.0};
  // In the corners of a square stick the distance exceeds 1.
  const double d =
      std::min((std::min(distance, 1.0) - settings.dead_zone) / (1.0 - settings.dead_zone), 1.0);
  const double bent = (1.0 - settings.expo) * d + settings.expo * d * d * d;
  return {raw.right / distance * bent, raw.down / distance * bent};
}

double MovedToward(double value, double target, double per_second, double seconds) {
  const double most = per_second * seconds;
  return value + std::clamp(target - value, -most, most);
}

void Controls::Set(const ControlSettings& settings) {
  RequireInRange(settings.dead_zone, 0.0, 0.9, "dead zone of the gamepad");
  RequireInRange(settings.expo, 0.0, 1.0, "expo of the gamepad");
  settings_ = settings;
}

void Controls::NextMouseMode() {
  mouse_mode_ = static_cast<MouseMode>((static_cast<int>(mouse_mode_) + 1) % 3);
}

// Looks around. A drag moves the scene; looking turns the head, which can be inverted.
void Controls::MoveMouse(const InputFrame& input, bool taken, PilotControls& pilot) {
  const auto& [width, height] = input.size;
  if (!input.events.pointer || width <= 0 || height <= 0) return;
  const WindowPoint place{input.events.pointer->right / width, input.events.pointer->down / height};
  const std::optional<WindowPoint> before = std::exchange(mouse_, place);
  if (!before || taken) return;
  const double moved_right = place.right - before->right;
  const double moved_down =
      (place.down - before->down) / std::max(static_cast<double>(width) / height, 1e-3);
  const bool drags = mouse_mode_ == MouseMode::kCursor && input.events.buttons[0];
  const bool looks = mouse_mode_ == MouseMode::kLook;
  const double hold = drags ? -1.0 : looks ? 1.0 : 0.0;
  pilot.look_right += hold * moved_right;
  pilot.look_up -= (looks && settings_.invert_look_y ? -hold : hold) * moved_down;
}

void Controls::LetGo() {
  held_.clear();
  camera_ = {};
  stick_ = {};
}

void Controls::Resolve(const KeyEvent& event, bool minimised, FlightMode mode, Intent& intent) {
  if (event.change == GLFW_RELEASE) {
    held_.erase(event.key);
    return;
  }
  const Action* here = ActionOfKey(event.key, event.modifiers, mode);
  if (here != nullptr && here->press == Press::kHeld) {
    if (!minimised && event.change == GLFW_PRESS) held_.insert_or_assign(event.key, here);
    return;
  }
  const int label = PrintedKey(event.key, event.printed.c_str());
  const Action* printed = ActionOfKey(label, event.modifiers, mode);
  if (printed == nullptr || printed->press == Press::kHeld) return;
  const bool again = event.change == GLFW_REPEAT;
  if (again && (minimised || printed->press != Press::kRepeating)) return;
  Perform(*printed, minimised, intent);
}

double Controls::Pushed(const HeldControl& control) const {
  double pushed = 0.0;
  for (const auto& [key, action] : held_) {
    if (action->moves.IsOf(control)) pushed += action->moves.sign;
  }
  return Within(pushed);
}

void Controls::MoveControls(double seconds) {
  for (const Action& action : ActionTable()) {
    const HeldControl& control = action.moves;
    if (action.press != Press::kHeld || control.sign < 0.0) continue;
    double& value = control.camera != nullptr ? camera_.*control.camera : stick_.*control.stick;
    // The throttle lever stays where it is released.
    value = control.stick == &Stick::throttle_up
                ? Pushed(control)
                : MovedToward(value, Pushed(control), kHandPerSecond, seconds);
  }
}

void Controls::AddMouse(FlightMode mode, PilotControls& pilot) const {
  if (mouse_mode_ != MouseMode::kFly || !mouse_) return;
  ControlSettings soft = settings_;
  soft.dead_zone = 0.04;
  const StickPlace place = Shaped({2.0 * mouse_->right - 1.0, 2.0 * mouse_->down - 1.0}, soft);
  const double back = settings_.invert_y ? -place.down : place.down;
  if (mode == FlightMode::kFree) {
    pilot.camera.turn_right = Within(pilot.camera.turn_right + place.right);
    pilot.camera.pitch_up = Within(pilot.camera.pitch_up - back);
  } else {
    pilot.stick.roll_right = Within(pilot.stick.roll_right + place.right);
    pilot.stick.pitch_up = Within(pilot.stick.pitch_up + back);
  }
}

void Controls::AddGamepad(const GamepadState& gamepad, FlightMode mode, double seconds,
                          PilotControls& pilot) const {
  constexpr double kLookPerSecond = 0.8;  // view widths
  const auto stick = [&](int right_axis, int down_axis) {
    return Shaped({AxisOf(gamepad, right_axis), AxisOf(gamepad, down_axis)}, settings_);
  };
  const StickPlace left = stick(GLFW_GAMEPAD_AXIS_LEFT_X, GLFW_GAMEPAD_AXIS_LEFT_Y);
  const StickPlace right = stick(GLFW_GAMEPAD_AXIS_RIGHT_X, GLFW_GAMEPAD_AXIS_RIGHT_Y);
  const double look_up = settings_.invert_look_y ? right.down : -right.down;
  const double lower = TriggerOf(gamepad, GLFW_GAMEPAD_AXIS_LEFT_TRIGGER);
  const double raise = TriggerOf(gamepad, GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER);
  if (mode == FlightMode::kFree) {
    pilot.camera.right = Within(pilot.camera.right + left.right);
    pilot.camera.forward = Within(pilot.camera.forward - left.down);
    pilot.camera.turn_right = Within(pilot.camera.turn_right + right.right);
    pilot.camera.pitch_up = Within(pilot.camera.pitch_up + look_up);
    pilot.camera.up = Within(pilot.camera.up + raise - lower);
    return;
  }
  pilot.look_right += kLookPerSecond * seconds * right.right;
  pilot.look_up += kLookPerSecond * seconds * look_up;
  const double rudder = (IsDown(gamepad, GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER) ? 1.0 : 0.0) -
                        (IsDown(gamepad, GLFW_GAMEPAD_BUTTON_LEFT_BUMPER) ? 1.0 : 0.0);
  pilot.stick.roll_right = Within(pilot.stick.roll_right + left.right);
  pilot.stick.pitch_up =
      Within(pilot.stick.pitch_up + (settings_.invert_y ? -left.down : left.down));
  pilot.stick.yaw_right = Within(pilot.stick.yaw_right + rudder);
  pilot.stick.throttle_up = Within(pilot.stick.throttle_up + raise - lower);
  pilot.stick.brake = std::clamp(pilot.stick.brake + lower, 0.0, 1.0);
}

void Controls::PressButtons(const GamepadState& gamepad, FlightMode mode, double seconds,
                            Intent& intent) {
  for (const Action& action : ActionTable()) {
    if (action.pad.button < 0) continue;
    double& held_s = button_held_s_[static_cast<std::size_t>(action.pad.button)];
    if (!IsDown(gamepad, action.pad.button)) {
      held_s = 0.0;
      continue;
    }
    const bool was_up = held_s == 0.0;
    const int acted = was_up ? 0 : TimesActed(held_s);
    // The first frame always counts, however short it is.
    held_s += was_up ? 1e-9 : seconds;
    const bool repeats = action.press == Press::kRepeating;
    const int times = repeats ? TimesActed(held_s) - acted : was_up ? 1 : 0;
    for (int i = 0; action.pad.modes.Has(mode) && i < times; ++i) Perform(action, false, intent);
  }
}

void Controls::TurnWheel(FlightMode mode, Intent& intent) {
  for (; wheel_ >= 1.0; wheel_ -= 1.0) intent.actions.push_back(&ActionOfWheel(1, mode));
  for (; wheel_ <= -1.0; wheel_ += 1.0) intent.actions.push_back(&ActionOfWheel(-1, mode));
}

Intent Controls::Interpret(const InputFrame& input, FlightMode mode, const TakenByPanels& taken) {
  const WindowEvents& events = input.events;
  Intent intent;
  if (!events.HasKeyboard()) LetGo();
  for (const KeyEvent& event : events.keys) {
    // Panels leave the releases of keys to the controls.
    if (!taken.keyboard || event.change == GLFW_RELEASE)
      Resolve(event, events.minimised, mode, intent);
  }
  MoveControls(input.seconds);
  intent.pilot = {camera_, stick_};
  MoveMouse(input, taken.mouse, intent.pilot);
  wheel_ = taken.mouse ? 0.0 : wheel_ + events.wheel;
  TurnWheel(mode, intent);
  if (!events.HasKeyboard()) return intent;
  if (!taken.mouse) AddMouse(mode, intent.pilot);
  if (events.gamepad) {
    AddGamepad(*events.gamepad, mode, input.seconds, intent.pilot);
    PressButtons(*events.gamepad, mode, input.seconds, intent);
  }
  return intent;
}

}  // namespace alpenglow::viewer
