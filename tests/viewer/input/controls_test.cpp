// SPDX-License-Identifier: MIT
#include "viewer/input/controls.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/error.h"
#include "tests/viewer/input/hands.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using tests::Hands;
using tests::KeysOf;

constexpr double kFrame_s = 1.0 / 60.0;

void Hold(Hands& controls, int key, int modifiers = 0) { controls.Key(key, GLFW_PRESS, modifiers); }
void Let(Hands& controls, int key) { controls.Key(key, GLFW_RELEASE, 0); }
void Tap(Hands& controls, int key, int modifiers = 0) {
  Hold(controls, key, modifiers);
  Let(controls, key);
}
GamepadState Pad() { return {}; }
void Push(GamepadState& pad, int axis, double value) {
  pad.axes[static_cast<std::size_t>(axis)] = static_cast<float>(value);
}
void Press(GamepadState& pad, int button, bool down = true) {
  pad.buttons[static_cast<std::size_t>(button)] = down ? GLFW_PRESS : GLFW_RELEASE;
}

TEST(Controls, AHeldKeyMovesItsControlToTheEndInAQuarterOfASecondAndBack) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  EXPECT_NEAR(controls.Take(FlightMode::kFree, 0.125).pilot.camera.forward, 0.5, 1e-12);
  EXPECT_NEAR(controls.Take(FlightMode::kFree, 0.125).pilot.camera.forward, 1.0, 1e-12);
  EXPECT_NEAR(controls.Take(FlightMode::kFree, 10.0).pilot.camera.forward, 1.0, 1e-12);
  Let(controls, GLFW_KEY_W);
  EXPECT_NEAR(controls.Take(FlightMode::kFree, 0.125).pilot.camera.forward, 0.5, 1e-12);
  EXPECT_EQ(controls.Take(FlightMode::kFree, 0.25).pilot.camera.forward, 0.0);
}

TEST(Controls, TheWayOfAControlDoesNotDependOnTheFrameRate) {
  Hands fast, slow;
  Hold(fast, GLFW_KEY_LEFT);
  Hold(slow, GLFW_KEY_LEFT);
  PilotControls at_last;
  for (int i = 0; i < 12; ++i) at_last = fast.Take(FlightMode::kAircraft, kFrame_s).pilot;
  EXPECT_NEAR(at_last.stick.roll_right,
              slow.Take(FlightMode::kAircraft, 0.2).pilot.stick.roll_right, 1e-12);
}

TEST(Controls, KeysThatOpposeEachOtherCancelAndTwoForOneThingAreOne) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  Hold(controls, GLFW_KEY_S);
  Hold(controls, GLFW_KEY_R);
  Hold(controls, GLFW_KEY_PAGE_UP);
  const PilotControls pilot = controls.Take(FlightMode::kFree, 1.0).pilot;
  EXPECT_EQ(pilot.camera.forward, 0.0);
  EXPECT_EQ(pilot.camera.up, 1.0);
}

TEST(Controls, ThePressesComeInTheirOrderAndOnlyOnce) {
  Hands controls;
  Tap(controls, GLFW_KEY_P);
  Tap(controls, GLFW_KEY_T);
  Tap(controls, GLFW_KEY_T, GLFW_MOD_SHIFT);
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("P", "T", "Shift+T"));
  EXPECT_THAT(controls.Take(FlightMode::kFree, kFrame_s).actions, IsEmpty());
}

TEST(Controls, ASwitchDoesNotRepeatAndAStepDoes) {
  Hands controls;
  for (const int key : {GLFW_KEY_P, GLFW_KEY_X}) {
    controls.Key(key, GLFW_PRESS, 0);
    controls.Key(key, GLFW_REPEAT, 0);
    controls.Key(key, GLFW_REPEAT, 0);
  }
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("P", "X", "X", "X"));
}

TEST(Controls, AKeyDoesInEachModeWhatTheTableSays) {
  Hands controls;
  Tap(controls, GLFW_KEY_W);
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kAircraft, kFrame_s).actions), ElementsAre("]"));
  Tap(controls, GLFW_KEY_W);
  EXPECT_THAT(controls.Take(FlightMode::kFree, kFrame_s).actions, IsEmpty());
}

TEST(Controls, WhatIsHeldGoesByThePlaceOfAKeyAndTheRestByItsPrint) {
  Hands controls;
  // A French keyboard: the key where Americans have W prints Z, the one of Z prints W.
  controls.Key(GLFW_KEY_W, GLFW_PRESS, 0, GLFW_KEY_Z);
  const Intent forward = controls.Take(FlightMode::kFree, 1.0);
  EXPECT_EQ(forward.pilot.camera.forward, 1.0);
  EXPECT_THAT(forward.actions, IsEmpty());
  controls.Key(GLFW_KEY_SEMICOLON, GLFW_PRESS, 0, GLFW_KEY_M);
  controls.Key(GLFW_KEY_Q, GLFW_PRESS, 0, GLFW_KEY_A);
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kAircraft, kFrame_s).actions), ElementsAre("A"));
}

// Hard case 49.
TEST(Controls, MinimisedNothingIsHeldSwitchesActAtOnceAndPicturesAreRefusedInWords) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  EXPECT_EQ(controls.Take(FlightMode::kFree, 1.0).pilot.camera.forward, 1.0);
  controls.Minimise(true);
  Hold(controls, GLFW_KEY_D);
  Tap(controls, GLFW_KEY_F3);
  Tap(controls, GLFW_KEY_P);
  controls.Key(GLFW_KEY_X, GLFW_REPEAT, 0);
  const Intent hidden = controls.Take(FlightMode::kFree, 1.0);
  EXPECT_EQ(hidden.pilot.camera.forward, 0.0) << "held when it was minimised";
  EXPECT_EQ(hidden.pilot.camera.right, 0.0) << "pressed while it is minimised";
  EXPECT_THAT(KeysOf(hidden.actions), ElementsAre("P"));
  EXPECT_THAT(KeysOf(hidden.refused), ElementsAre("F3"));
  controls.Minimise(false);
  controls.Key(GLFW_KEY_D, GLFW_REPEAT, 0);
  const Intent shown = controls.Take(FlightMode::kFree, 1.0);
  EXPECT_EQ(shown.pilot.camera.right, 0.0) << "nothing acts later";
  EXPECT_THAT(shown.actions, IsEmpty());
  EXPECT_THAT(shown.refused, IsEmpty());
}

TEST(Controls, AWindowThatLosesTheKeyboardLetsGo) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  static_cast<void>(controls.Take(FlightMode::kFree, 1.0));
  controls.Focus(false);
  GamepadState pad = Pad();
  Push(pad, GLFW_GAMEPAD_AXIS_LEFT_X, 1.0);
  Press(pad, GLFW_GAMEPAD_BUTTON_START);
  const Intent intent = controls.Take(FlightMode::kFree, kFrame_s, pad);
  EXPECT_EQ(intent.pilot.camera.forward, 0.0) << "its release goes to another window";
  EXPECT_EQ(intent.pilot.camera.right, 0.0) << "and the gamepad flies another game";
  EXPECT_THAT(intent.actions, IsEmpty());
  controls.Focus(true);
  EXPECT_GT(controls.Take(FlightMode::kFree, kFrame_s, pad).pilot.camera.right, 0.9);
}

TEST(Controls, ADragTakesHoldOfTheSceneAndLookingTurnsTheHead) {
  Hands controls;
  constexpr double kWide = 2.0;
  controls.MouseAt(0.5, 0.5, kWide);
  static_cast<void>(controls.Take(FlightMode::kFree, kFrame_s));
  controls.MouseAt(0.7, 0.5, kWide);
  EXPECT_EQ(controls.Take(FlightMode::kFree, kFrame_s).pilot.look_right, 0.0) << "no button";
  controls.MouseButton(true);
  controls.MouseAt(0.8, 0.7, kWide);
  const PilotControls dragged = controls.Take(FlightMode::kFree, kFrame_s).pilot;
  EXPECT_NEAR(dragged.look_right, -0.1, 1e-12);
  EXPECT_NEAR(dragged.look_up, 0.1, 1e-12) << "a fifth of the height is a tenth of the width";
  controls.MouseButton(false);
  Tap(controls, GLFW_KEY_TAB);
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kFree, kFrame_s).actions), ElementsAre("Tab"));
  controls.controls.NextMouseMode();
  EXPECT_EQ(controls.controls.mouse_mode(), MouseMode::kLook);
  controls.MouseAt(0.9, 0.5, kWide);
  const PilotControls looked = controls.Take(FlightMode::kFree, kFrame_s).pilot;
  EXPECT_NEAR(looked.look_right, 0.1, 1e-12);
  EXPECT_NEAR(looked.look_up, 0.1, 1e-12) << "forward looks up";
}

TEST(Controls, TheInstrumentsKeepWhatTheMouseDoesOnThem) {
  Hands controls;
  controls.MouseAt(0.5, 0.5, 1.0);
  static_cast<void>(controls.Take(FlightMode::kFree, kFrame_s));
  controls.MouseButton(true);
  controls.IgnoreMouse(true);
  controls.MouseAt(0.9, 0.5, 1.0);
  controls.Wheel(3.0);
  const Intent intent = controls.Take(FlightMode::kFree, kFrame_s);
  EXPECT_EQ(intent.pilot.look_right, 0.0);
  EXPECT_THAT(intent.actions, IsEmpty());
}

TEST(Controls, TheMouseFliesFromTheMiddleOfTheWindow) {
  Hands controls;
  controls.controls.NextMouseMode();
  controls.controls.NextMouseMode();
  controls.MouseAt(0.5, 0.5, 1.0);
  Intent intent = controls.Take(FlightMode::kAircraft, kFrame_s);
  EXPECT_EQ(controls.controls.mouse_mode(), MouseMode::kFly);
  EXPECT_EQ(intent.pilot.stick.roll_right, 0.0);
  controls.MouseAt(1.0, 0.5, 1.0);
  EXPECT_NEAR(controls.Take(FlightMode::kAircraft, kFrame_s).pilot.stick.roll_right, 1.0, 1e-12);
  controls.MouseAt(0.5, 1.0, 1.0);
  EXPECT_NEAR(controls.Take(FlightMode::kAircraft, kFrame_s).pilot.stick.pitch_up, 1.0, 1e-12)
      << "pulled back, the nose rises";
  controls.controls.Set({.invert_y = true});
  EXPECT_NEAR(controls.Take(FlightMode::kAircraft, kFrame_s).pilot.stick.pitch_up, -1.0, 1e-12);
}

TEST(Controls, TheWheelChangesTheSpeedByWholeSteps) {
  Hands controls;
  controls.Wheel(0.6);
  EXPECT_THAT(controls.Take(FlightMode::kFree, kFrame_s).actions, IsEmpty());
  controls.Wheel(0.6);
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("+, Keypad +"));
  controls.Wheel(-2.2);
  EXPECT_THAT(KeysOf(controls.Take(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("-, Keypad -", "-, Keypad -"));
}

TEST(Gamepad, AStickIsDeadInTheMiddleWholeAtItsEndAndKeepsItsDirection) {
  const ControlSettings settings{.dead_zone = 0.2, .expo = 0.5};
  EXPECT_EQ(Shaped({0.1, -0.17}, settings).right, 0.0);
  EXPECT_NEAR(Shaped({1.0, 0.0}, settings).right, 1.0, 1e-15);
  EXPECT_NEAR(Shaped({-0.0, -1.0}, settings).down, -1.0, 1e-15);
  const StickPlace corner = Shaped({1.0, 1.0}, settings);
  EXPECT_NEAR(std::hypot(corner.right, corner.down), 1.0, 1e-15) << "of a square stick";
  const StickPlace half = Shaped({0.6 * 0.6, 0.6 * 0.8}, settings);
  EXPECT_NEAR(half.right / half.down, 0.75, 1e-12);
  EXPECT_NEAR(std::hypot(half.right, half.down), 0.5 * 0.5 + 0.5 * 0.125, 1e-12)
      << "half way after the dead zone, half linear and half cubic";
}

TEST(Gamepad, AStickGrowsWithoutAJumpAtTheEdgeOfTheDeadZone) {
  const ControlSettings settings;
  double before = 0.0;
  for (double x = 0.0; x <= 1.0; x += 0.001) {
    const double now = Shaped({x, 0.0}, settings).right;
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 0.003) << "steepest at the end: (1 - e + 3 e) / (1 - dead) = 2.3";
    before = now;
  }
}

TEST(Gamepad, SticksAndTriggersFlyTheAircraftAndMoveTheCamera) {
  Hands controls;
  GamepadState pad = Pad();
  Push(pad, GLFW_GAMEPAD_AXIS_LEFT_X, 1.0);
  Push(pad, GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER, 1.0);
  Press(pad, GLFW_GAMEPAD_BUTTON_LEFT_BUMPER);
  const PilotControls flown = controls.Take(FlightMode::kAircraft, kFrame_s, pad).pilot;
  EXPECT_NEAR(flown.stick.roll_right, 1.0, 1e-12);
  EXPECT_NEAR(flown.stick.throttle_up, 1.0, 1e-12);
  EXPECT_EQ(flown.stick.yaw_right, -1.0);
  EXPECT_EQ(flown.stick.brake, 0.0);
  const PilotControls free = controls.Take(FlightMode::kFree, kFrame_s, pad).pilot;
  EXPECT_NEAR(free.camera.right, 1.0, 1e-12);
  EXPECT_NEAR(free.camera.up, 1.0, 1e-12);
  EXPECT_EQ(free.stick.roll_right, 0.0);
}

TEST(Gamepad, PulledBackTheNoseRisesAndInvertedItSinks) {
  Hands controls;
  GamepadState pad = Pad();
  Push(pad, GLFW_GAMEPAD_AXIS_LEFT_Y, 1.0);
  EXPECT_NEAR(controls.Take(FlightMode::kAircraft, kFrame_s, pad).pilot.stick.pitch_up, 1.0, 1e-12);
  controls.controls.Set({.invert_y = true});
  EXPECT_NEAR(controls.Take(FlightMode::kAircraft, kFrame_s, pad).pilot.stick.pitch_up, -1.0,
              1e-12);
}

TEST(Gamepad, SettingsOutOfRangeAreRefused) {
  EXPECT_THROW(Controls({.dead_zone = 0.95}), InputError);
  EXPECT_THROW(Controls({.dead_zone = std::nan("")}), InputError);
  EXPECT_THROW(Controls({.expo = 1.5}), InputError);
}

TEST(Gamepad, AnUntouchedPadAsksForNothing) {
  Hands controls;
  const Intent intent = controls.Take(FlightMode::kAircraft, kFrame_s, Pad());
  EXPECT_EQ(intent.pilot.stick.throttle_up, 0.0) << "triggers rest at -1";
  EXPECT_EQ(intent.pilot.stick.brake, 0.0);
  EXPECT_THAT(intent.actions, IsEmpty());
}

TEST(Gamepad, AButtonPressesOnceAndTheCrossRepeats) {
  Hands controls;
  GamepadState pad = Pad();
  Press(pad, GLFW_GAMEPAD_BUTTON_START);
  Press(pad, GLFW_GAMEPAD_BUTTON_DPAD_RIGHT);
  int pauses = 0, minutes = 0;
  for (int i = 0; i < 62; ++i) {
    for (const Action* action : controls.Take(FlightMode::kFree, kFrame_s, pad).actions) {
      pauses += action->keys == "P" ? 1 : 0;
      minutes += action->keys == "]" ? 1 : 0;
    }
  }
  EXPECT_EQ(pauses, 1);
  EXPECT_EQ(minutes, 1 + 7) << "at once, then every tenth of a second from 0.4 s on, for a second";
  controls.Minimise(true);
  EXPECT_THAT(controls.Take(FlightMode::kFree, kFrame_s, pad).actions, IsEmpty());
}

}  // namespace
}  // namespace alpenglow::viewer
