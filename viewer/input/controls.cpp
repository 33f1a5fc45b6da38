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

bool NeedsPicture(Action action) {
  return action == Action::kScreenshot || action == Action::kScreenshotExr;
}

struct ButtonRow {
  int button;
  Action action;
  Modes modes;
};
constexpr Modes kEveryMode{true, true, true}, kNoRudder{true, false, true};
constexpr ButtonRow kButtons[] = {
    {GLFW_GAMEPAD_BUTTON_A, Action::kCentre, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_B, Action::kNextMode, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_X, Action::kScreenshot, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_Y, Action::kHud, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_BACK, Action::kHelp, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_START, Action::kPause, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_RIGHT_THUMB, Action::kResetView, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_LEFT_BUMPER, Action::kWiderView, kNoRudder},
    {GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER, Action::kNarrowerView, kNoRudder},
    {GLFW_GAMEPAD_BUTTON_DPAD_UP, Action::kBrighter, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_DPAD_DOWN, Action::kDarker, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_DPAD_RIGHT, Action::kLaterMinute, kEveryMode},
    {GLFW_GAMEPAD_BUTTON_DPAD_LEFT, Action::kEarlierMinute, kEveryMode},
};

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

void Controls::Key(int key, int change, int modifiers, int printed) {
  events_.push_back({key, change, modifiers, printed, minimised_});
}

void Controls::MouseAt(double right, double down, double width_to_height) {
  if (mouse_ && !mouse_is_ignored_) {
    const double moved_right = right - mouse_->right;
    const double moved_down = (down - mouse_->down) / std::max(width_to_height, 1e-3);
    const bool drags = mouse_mode_ == MouseMode::kCursor && dragging_;
    const bool looks = mouse_mode_ == MouseMode::kLook;
    // A drag moves the scene; looking turns the head, which can be inverted.
    const double hold = drags ? -1.0 : looks ? 1.0 : 0.0;
    look_right_ += hold * moved_right;
    look_up_ -= (looks && settings_.invert_look_y ? -hold : hold) * moved_down;
  }
  mouse_ = Place{right, down};
}

void Controls::LetGo() {
  held_.clear();
  dragging_ = false;
  camera_ = {};
  stick_ = {};
}

void Controls::Focus(bool focused) {
  focused_ = focused;
  if (!focused) LetGo();
}

void Controls::Minimise(bool minimised) {
  minimised_ = minimised;
  if (minimised) LetGo();
}

void Controls::Ask(Action action, Intent& intent) {
  if (NeedsPicture(action) && minimised_) {
    intent.refused.push_back(action);
    return;
  }
  if (action == Action::kMouseMode) {
    mouse_mode_ = static_cast<MouseMode>((static_cast<int>(mouse_mode_) + 1) % 3);
  }
  intent.actions.push_back(action);
}

void Controls::Resolve(const KeyEvent& event, FlightMode mode, Intent& intent) {
  if (event.change == GLFW_RELEASE) {
    held_.erase(event.key);
    return;
  }
  const std::optional<Action> here = ActionOfKey(event.key, event.modifiers, mode);
  if (here && RowOf(*here).press == Press::kHeld) {
    if (!event.minimised && event.change == GLFW_PRESS) held_.insert_or_assign(event.key, *here);
    return;
  }
  const std::optional<Action> printed = ActionOfKey(event.printed, event.modifiers, mode);
  if (!printed || RowOf(*printed).press == Press::kHeld) return;
  const bool again = event.change == GLFW_REPEAT;
  if (again && (event.minimised || RowOf(*printed).press != Press::kRepeating)) return;
  Ask(*printed, intent);
}

double Controls::Pushed(Action positive, Action negative) const {
  double pushed = 0.0;
  for (const auto& [key, action] : held_) {
    pushed += action == positive ? 1.0 : action == negative ? -1.0 : 0.0;
  }
  return Within(pushed);
}

void Controls::MoveControls(double seconds) {
  const auto move = [&](double& value, Action positive, Action negative) {
    value = MovedToward(value, Pushed(positive, negative), kHandPerSecond, seconds);
  };
  move(camera_.forward, Action::kForward, Action::kBack);
  move(camera_.right, Action::kRight, Action::kLeft);
  move(camera_.up, Action::kUp, Action::kDown);
  move(camera_.turn_right, Action::kTurnRight, Action::kTurnLeft);
  move(camera_.pitch_up, Action::kLookUp, Action::kLookDown);
  move(camera_.roll_right, Action::kRollRight, Action::kRollLeft);
  move(stick_.pitch_up, Action::kNoseUp, Action::kNoseDown);
  move(stick_.roll_right, Action::kBankRight, Action::kBankLeft);
  move(stick_.yaw_right, Action::kRudderRight, Action::kRudderLeft);
  move(stick_.brake, Action::kBrake, Action::kBrake);
  // The throttle lever stays where it is released.
  stick_.throttle_up = Pushed(Action::kThrottleUp, Action::kThrottleDown);
}

void Controls::AddMouse(FlightMode mode, PilotControls& pilot) const {
  if (mouse_mode_ != MouseMode::kFly || !mouse_ || mouse_is_ignored_) return;
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
  for (const ButtonRow& row : kButtons) {
    double& held_s = button_held_s_[static_cast<std::size_t>(row.button)];
    if (!IsDown(gamepad, row.button)) {
      held_s = 0.0;
      continue;
    }
    const bool was_up = held_s == 0.0;
    const int acted = was_up ? 0 : TimesActed(held_s);
    // The first frame always counts, however short it is.
    held_s += was_up ? 1e-9 : seconds;
    const bool repeats = RowOf(row.action).press == Press::kRepeating;
    const int times = repeats ? TimesActed(held_s) - acted : was_up ? 1 : 0;
    for (int i = 0; row.modes.Has(mode) && i < times; ++i) Ask(row.action, intent);
  }
}

void Controls::TurnWheel(FlightMode mode, Intent& intent) {
  if (mouse_is_ignored_) wheel_ = 0.0;
  const bool flies = mode == FlightMode::kAircraft;
  const Action forward = flies ? Action::kNarrowerView : Action::kFaster;
  const Action back = flies ? Action::kWiderView : Action::kSlower;
  for (; wheel_ >= 1.0; wheel_ -= 1.0) Ask(forward, intent);
  for (; wheel_ <= -1.0; wheel_ += 1.0) Ask(back, intent);
}

Intent Controls::Take(FlightMode mode, double seconds, const std::optional<GamepadState>& gamepad) {
  Intent intent;
  for (const KeyEvent& event : std::exchange(events_, {})) Resolve(event, mode, intent);
  MoveControls(seconds);
  intent.pilot = {camera_, stick_, std::exchange(look_right_, 0.0), std::exchange(look_up_, 0.0)};
  TurnWheel(mode, intent);
  if (minimised_ || !focused_) return intent;
  AddMouse(mode, intent.pilot);
  if (gamepad) {
    AddGamepad(*gamepad, mode, seconds, intent.pilot);
    PressButtons(*gamepad, mode, seconds, intent);
  }
  return intent;
}

}  // namespace alpenglow::viewer
