// SPDX-License-Identifier: MIT
// Keys, gamepads and pointers, the actions they stand for, and the flight under one hand.
#include "viewer/input/controls.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/places.h"
#include "tests/viewer/input/hands.h"
#include "tests/viewer/input/recorded_commands.h"
#include "viewer/flight/flight_controller.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::Hands;
using tests::KeysOf;
using tests::RecordedCommands;

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

TEST(Controls, AHeldKeyReachesFullDeflectionInAQuarterSecond) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  EXPECT_NEAR(controls.Interpret(FlightMode::kFree, 0.125).pilot.camera.forward, 0.5, 1e-12);
  EXPECT_NEAR(controls.Interpret(FlightMode::kFree, 0.125).pilot.camera.forward, 1.0, 1e-12);
  EXPECT_NEAR(controls.Interpret(FlightMode::kFree, 10.0).pilot.camera.forward, 1.0, 1e-12);
  Let(controls, GLFW_KEY_W);
  EXPECT_NEAR(controls.Interpret(FlightMode::kFree, 0.125).pilot.camera.forward, 0.5, 1e-12);
  EXPECT_EQ(controls.Interpret(FlightMode::kFree, 0.25).pilot.camera.forward, 0.0);
}

TEST(Controls, DeflectionDoesNotDependOnTheFrameRate) {
  Hands fast, slow;
  Hold(fast, GLFW_KEY_LEFT);
  Hold(slow, GLFW_KEY_LEFT);
  PilotControls at_last;
  for (int i = 0; i < 12; ++i) at_last = fast.Interpret(FlightMode::kAircraft, kFrame_s).pilot;
  EXPECT_NEAR(at_last.stick.roll_right,
              slow.Interpret(FlightMode::kAircraft, 0.2).pilot.stick.roll_right, 1e-12);
}

TEST(Controls, OppositeKeysCancelAndEqualKeysCountOnce) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  Hold(controls, GLFW_KEY_S);
  Hold(controls, GLFW_KEY_R);
  Hold(controls, GLFW_KEY_PAGE_UP);
  const PilotControls pilot = controls.Interpret(FlightMode::kFree, 1.0).pilot;
  EXPECT_EQ(pilot.camera.forward, 0.0);
  EXPECT_EQ(pilot.camera.up, 1.0);
}

TEST(Controls, PressesArriveInOrderAndOnce) {
  Hands controls;
  Tap(controls, GLFW_KEY_P);
  Tap(controls, GLFW_KEY_T);
  Tap(controls, GLFW_KEY_T, GLFW_MOD_SHIFT);
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("P", "T", "Shift+T"));
  EXPECT_THAT(controls.Interpret(FlightMode::kFree, kFrame_s).actions, IsEmpty());
}

TEST(Controls, AHeldKeyRepeatsStepsButNotSwitches) {
  Hands controls;
  for (const int key : {GLFW_KEY_P, GLFW_KEY_X}) {
    controls.Key(key, GLFW_PRESS, 0);
    controls.Key(key, GLFW_REPEAT, 0);
    controls.Key(key, GLFW_REPEAT, 0);
  }
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("P", "X", "X", "X"));
}

TEST(Controls, KeysActByModeAsInTheTable) {
  Hands controls;
  Tap(controls, GLFW_KEY_W);
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kAircraft, kFrame_s).actions),
              ElementsAre("]"));
  Tap(controls, GLFW_KEY_W);
  EXPECT_THAT(controls.Interpret(FlightMode::kFree, kFrame_s).actions, IsEmpty());
}

TEST(Controls, HeldKeysGoByPositionAndPressesByTheirLetter) {
  Hands controls;
  // A French keyboard: the key where Americans have W prints Z, the one of Z prints W.
  controls.Key(GLFW_KEY_W, GLFW_PRESS, 0, GLFW_KEY_Z);
  const Intent forward = controls.Interpret(FlightMode::kFree, 1.0);
  EXPECT_EQ(forward.pilot.camera.forward, 1.0);
  EXPECT_THAT(forward.actions, IsEmpty());
  controls.Key(GLFW_KEY_SEMICOLON, GLFW_PRESS, 0, GLFW_KEY_M);
  controls.Key(GLFW_KEY_Q, GLFW_PRESS, 0, GLFW_KEY_A);
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kAircraft, kFrame_s).actions),
              ElementsAre("A"));
}

// Hard case 49.
TEST(Controls, MinimisedWindowHoldsNoKeysAndRefusesPictures) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  EXPECT_EQ(controls.Interpret(FlightMode::kFree, 1.0).pilot.camera.forward, 1.0);
  controls.Minimise(true);
  Hold(controls, GLFW_KEY_D);
  Tap(controls, GLFW_KEY_F3);
  Tap(controls, GLFW_KEY_P);
  controls.Key(GLFW_KEY_X, GLFW_REPEAT, 0);
  const Intent hidden = controls.Interpret(FlightMode::kFree, 1.0);
  EXPECT_EQ(hidden.pilot.camera.forward, 0.0) << "held when it was minimised";
  EXPECT_EQ(hidden.pilot.camera.right, 0.0) << "pressed while it is minimised";
  EXPECT_THAT(KeysOf(hidden.actions), ElementsAre("P"));
  EXPECT_THAT(KeysOf(hidden.refused), ElementsAre("F3"));
  controls.Minimise(false);
  controls.Key(GLFW_KEY_D, GLFW_REPEAT, 0);
  const Intent shown = controls.Interpret(FlightMode::kFree, 1.0);
  EXPECT_EQ(shown.pilot.camera.right, 0.0) << "nothing acts later";
  EXPECT_THAT(shown.actions, IsEmpty());
  EXPECT_THAT(shown.refused, IsEmpty());
}

TEST(Controls, LosingTheKeyboardReleasesAllControls) {
  Hands controls;
  Hold(controls, GLFW_KEY_W);
  static_cast<void>(controls.Interpret(FlightMode::kFree, 1.0));
  controls.Focus(false);
  GamepadState pad = Pad();
  Push(pad, GLFW_GAMEPAD_AXIS_LEFT_X, 1.0);
  Press(pad, GLFW_GAMEPAD_BUTTON_START);
  const Intent intent = controls.Interpret(FlightMode::kFree, kFrame_s, pad);
  EXPECT_EQ(intent.pilot.camera.forward, 0.0) << "its release goes to another window";
  EXPECT_EQ(intent.pilot.camera.right, 0.0) << "and the gamepad flies another game";
  EXPECT_THAT(intent.actions, IsEmpty());
  controls.Focus(true);
  EXPECT_GT(controls.Interpret(FlightMode::kFree, kFrame_s, pad).pilot.camera.right, 0.9);
}

TEST(Controls, DraggingMovesTheSceneAndLookingTurnsTheHead) {
  Hands controls;
  constexpr double kWide = 2.0;
  controls.MouseAt(0.5, 0.5, kWide);
  static_cast<void>(controls.Interpret(FlightMode::kFree, kFrame_s));
  controls.MouseAt(0.7, 0.5, kWide);
  EXPECT_EQ(controls.Interpret(FlightMode::kFree, kFrame_s).pilot.look_right, 0.0) << "no button";
  controls.MouseButton(true);
  controls.MouseAt(0.8, 0.7, kWide);
  const PilotControls dragged = controls.Interpret(FlightMode::kFree, kFrame_s).pilot;
  EXPECT_NEAR(dragged.look_right, -0.1, 1e-12);
  EXPECT_NEAR(dragged.look_up, 0.1, 1e-12) << "a fifth of the height is a tenth of the width";
  controls.MouseButton(false);
  Tap(controls, GLFW_KEY_TAB);
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kFree, kFrame_s).actions), ElementsAre("Tab"));
  controls.controls.NextMouseMode();
  EXPECT_EQ(controls.controls.mouse_mode(), MouseMode::kLook);
  controls.MouseAt(0.9, 0.5, kWide);
  const PilotControls looked = controls.Interpret(FlightMode::kFree, kFrame_s).pilot;
  EXPECT_NEAR(looked.look_right, 0.1, 1e-12);
  EXPECT_NEAR(looked.look_up, 0.1, 1e-12) << "forward looks up";
}

TEST(Controls, MouseOnInstrumentsDoesNotMoveTheView) {
  Hands controls;
  controls.MouseAt(0.5, 0.5, 1.0);
  static_cast<void>(controls.Interpret(FlightMode::kFree, kFrame_s));
  controls.MouseButton(true);
  controls.IgnoreMouse(true);
  controls.MouseAt(0.9, 0.5, 1.0);
  controls.Wheel(3.0);
  const Intent intent = controls.Interpret(FlightMode::kFree, kFrame_s);
  EXPECT_EQ(intent.pilot.look_right, 0.0);
  EXPECT_THAT(intent.actions, IsEmpty());
}

TEST(Controls, MouseSteersRelativeToTheMiddleOfTheWindow) {
  Hands controls;
  controls.controls.NextMouseMode();
  controls.controls.NextMouseMode();
  controls.MouseAt(0.5, 0.5, 1.0);
  Intent intent = controls.Interpret(FlightMode::kAircraft, kFrame_s);
  EXPECT_EQ(controls.controls.mouse_mode(), MouseMode::kFly);
  EXPECT_EQ(intent.pilot.stick.roll_right, 0.0);
  controls.MouseAt(1.0, 0.5, 1.0);
  EXPECT_NEAR(controls.Interpret(FlightMode::kAircraft, kFrame_s).pilot.stick.roll_right, 1.0,
              1e-12);
  controls.MouseAt(0.5, 1.0, 1.0);
  EXPECT_NEAR(controls.Interpret(FlightMode::kAircraft, kFrame_s).pilot.stick.pitch_up, 1.0, 1e-12)
      << "pulled back, the nose rises";
  controls.controls.Set({.invert_y = true});
  EXPECT_NEAR(controls.Interpret(FlightMode::kAircraft, kFrame_s).pilot.stick.pitch_up, -1.0,
              1e-12);
}

TEST(Controls, WheelChangesTheSpeedByWholeSteps) {
  Hands controls;
  controls.Wheel(0.6);
  EXPECT_THAT(controls.Interpret(FlightMode::kFree, kFrame_s).actions, IsEmpty());
  controls.Wheel(0.6);
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("+, Keypad +"));
  controls.Wheel(-2.2);
  EXPECT_THAT(KeysOf(controls.Interpret(FlightMode::kFree, kFrame_s).actions),
              ElementsAre("-, Keypad -", "-, Keypad -"));
}

TEST(Gamepad, StickHasADeadZoneAFullEndAndKeepsDirection) {
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

TEST(Gamepad, StickIsContinuousAtTheEdgeOfTheDeadZone) {
  const ControlSettings settings;
  double before = 0.0;
  for (double x = 0.0; x <= 1.0; x += 0.001) {
    const double now = Shaped({x, 0.0}, settings).right;
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 0.003) << "steepest at the end: (1 - e + 3 e) / (1 - dead) = 2.3";
    before = now;
  }
}

TEST(Gamepad, SticksAndTriggersMoveAircraftAndCamera) {
  Hands controls;
  GamepadState pad = Pad();
  Push(pad, GLFW_GAMEPAD_AXIS_LEFT_X, 1.0);
  Push(pad, GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER, 1.0);
  Press(pad, GLFW_GAMEPAD_BUTTON_LEFT_BUMPER);
  const PilotControls flown = controls.Interpret(FlightMode::kAircraft, kFrame_s, pad).pilot;
  EXPECT_NEAR(flown.stick.roll_right, 1.0, 1e-12);
  EXPECT_NEAR(flown.stick.throttle_up, 1.0, 1e-12);
  EXPECT_EQ(flown.stick.yaw_right, -1.0);
  EXPECT_EQ(flown.stick.brake, 0.0);
  const PilotControls free = controls.Interpret(FlightMode::kFree, kFrame_s, pad).pilot;
  EXPECT_NEAR(free.camera.right, 1.0, 1e-12);
  EXPECT_NEAR(free.camera.up, 1.0, 1e-12);
  EXPECT_EQ(free.stick.roll_right, 0.0);
}

TEST(Gamepad, PullingRaisesTheNoseUnlessInverted) {
  Hands controls;
  GamepadState pad = Pad();
  Push(pad, GLFW_GAMEPAD_AXIS_LEFT_Y, 1.0);
  EXPECT_NEAR(controls.Interpret(FlightMode::kAircraft, kFrame_s, pad).pilot.stick.pitch_up, 1.0,
              1e-12);
  controls.controls.Set({.invert_y = true});
  EXPECT_NEAR(controls.Interpret(FlightMode::kAircraft, kFrame_s, pad).pilot.stick.pitch_up, -1.0,
              1e-12);
}

TEST(Gamepad, SettingsOutOfRangeAreRefused) {
  EXPECT_THROW(Controls({.dead_zone = 0.95}), InputError);
  EXPECT_THROW(Controls({.dead_zone = std::nan("")}), InputError);
  EXPECT_THROW(Controls({.expo = 1.5}), InputError);
}

TEST(Gamepad, AnUntouchedPadRequestsNothing) {
  Hands controls;
  const Intent intent = controls.Interpret(FlightMode::kAircraft, kFrame_s, Pad());
  EXPECT_EQ(intent.pilot.stick.throttle_up, 0.0) << "triggers rest at -1";
  EXPECT_EQ(intent.pilot.stick.brake, 0.0);
  EXPECT_THAT(intent.actions, IsEmpty());
}

TEST(Gamepad, ButtonsPressOnceAndTheCrossRepeats) {
  Hands controls;
  GamepadState pad = Pad();
  Press(pad, GLFW_GAMEPAD_BUTTON_START);
  Press(pad, GLFW_GAMEPAD_BUTTON_DPAD_RIGHT);
  int pauses = 0, minutes = 0;
  for (int i = 0; i < 62; ++i) {
    for (const Action* action : controls.Interpret(FlightMode::kFree, kFrame_s, pad).actions) {
      pauses += action->keys == "P" ? 1 : 0;
      minutes += action->keys == "]" ? 1 : 0;
    }
  }
  EXPECT_EQ(pauses, 1);
  EXPECT_EQ(minutes, 1 + 7) << "at once, then every tenth of a second from 0.4 s on, for a second";
  controls.Minimise(true);
  EXPECT_THAT(controls.Interpret(FlightMode::kFree, kFrame_s, pad).actions, IsEmpty());
}

// --- actions ---

constexpr FlightMode kModes[] = {FlightMode::kFree, FlightMode::kAircraft, FlightMode::kTrack};

TEST(Action, EveryActionHasKeysAndAnEffect) {
  for (const Action& action : ActionTable()) {
    EXPECT_FALSE(action.keys.empty()) << action.help;
    const bool moves = action.moves.camera != nullptr || action.moves.stick != nullptr;
    EXPECT_EQ(moves, action.press == Press::kHeld) << action.help;
    EXPECT_NE(moves, action.run != nullptr) << action.help;
  }
}

TEST(Action, EveryControlHasOneKeyForEachDirection) {
  for (const Action& action : ActionTable()) {
    if (action.press != Press::kHeld) continue;
    int forward = 0, back = 0;
    for (const Action& other : ActionTable()) {
      if (other.press == Press::kHeld && other.moves.IsOf(action.moves))
        ++(other.moves.sign > 0.0 ? forward : back);
    }
    EXPECT_EQ(forward, 1) << action.help;
    EXPECT_EQ(back, action.moves.stick == &Stick::brake ? 0 : 1) << action.help;
  }
}

/// Visits all keys of the table: chord, row, and whether the key acts only outside the free camera.
template <typename Visit>
void ForEachKey(const Visit& visit) {
  for (const Action& row : ActionTable()) {
    for (const bool not_free : {false, true}) {
      std::string keys(not_free ? row.keys_outside_free_camera : row.keys);
      for (std::size_t begin = 0; begin < keys.size();) {
        const std::size_t end = std::min(keys.find(", ", begin), keys.size());
        visit(keys.substr(begin, end - begin), row, not_free);
        begin = end + 2;
      }
    }
  }
}

TEST(Action, EveryKeyHasTheEffectOfItsLineAndNoOther) {
  int keys = 0;
  ForEachKey([&](const std::string& text, const Action& row, bool not_free) {
    const KeyChord chord = KeyChordFromText(text);
    for (const FlightMode mode : kModes) {
      if (!row.modes.Has(mode) || (not_free && mode == FlightMode::kFree)) continue;
      const Action* action = ActionOfKey(chord.key, chord.modifiers, mode);
      ASSERT_NE(action, nullptr) << text;
      EXPECT_EQ(action->help, row.help) << text << " in mode " << static_cast<int>(mode);
      ++keys;
    }
  });
  EXPECT_GT(keys, 150);
}

TEST(Action, NoKeyIsListedTwiceForOneMode) {
  for (const FlightMode mode : kModes) {
    std::vector<std::pair<int, int>> chords;
    ForEachKey([&](const std::string& text, const Action& row, bool not_free) {
      if (!row.modes.Has(mode) || (not_free && mode == FlightMode::kFree)) return;
      const KeyChord chord = KeyChordFromText(text);
      const std::pair<int, int> pair{chord.key, chord.modifiers};
      EXPECT_THAT(chords, ::testing::Not(::testing::Contains(pair)))
          << text << " in mode " << static_cast<int>(mode);
      chords.push_back(pair);
    });
  }
}

TEST(Action, EveryActionIsInOneSection) {
  std::vector<std::string_view> headings, actions;
  for (const ActionSection& section : ActionSections()) {
    headings.push_back(section.heading);
    for (const Action& row : section.rows) {
      EXPECT_EQ(row.heading, section.heading) << row.help;
      EXPECT_EQ(row.modes.free, section.rows.front().modes.free) << row.help;
      EXPECT_EQ(row.modes.aircraft, section.rows.front().modes.aircraft) << row.help;
      EXPECT_EQ(row.modes.track, section.rows.front().modes.track) << row.help;
      actions.push_back(row.help);
    }
  }
  EXPECT_EQ(actions.size(), ActionTable().size());
  for (std::vector<std::string_view>* texts : {&headings, &actions}) {
    std::sort(texts->begin(), texts->end());
    const auto twice = std::adjacent_find(texts->begin(), texts->end());
    EXPECT_EQ(twice, texts->end()) << *twice;
  }
}

/// The help text of a key; "" without an action.
std::string_view HelpOf(const char* text, FlightMode mode) {
  const KeyChord chord = KeyChordFromText(text);
  const Action* action = ActionOfKey(chord.key, chord.modifiers, mode);
  return action == nullptr ? "" : action->help;
}

TEST(Action, FlightKeysAreThoseOfFlightGear) {
  const std::pair<const char*, const char*> keys[] = {
      {"Up", "stick forward: nose down"},  // elevator down
      {"Keypad 2", "stick back: nose up"},
      {"Keypad 5", "centre the stick; look ahead, level"},
      {"9", "more throttle"},
      {"Page Down", "less throttle"},
      {"0", "rudder to the left"},
      {"Enter", "rudder to the right"},
      {"P", "pause time, aircraft and track"},
      {"A", "flight twice as fast, up to 32 times"},
      {"Shift+A", "flight half as fast, down to real time"},
      {"T", "rate of time up: -3600 to 3600"},
      {"W", "a minute later"},
      {"Shift+W", "a minute earlier"},
      {"X", "narrower view (aircraft: also the wheel)"},
      {"Ctrl+X", "field of view of the scene"},
      {"Z", "farther visibility"},
      {"Ctrl+Z", "visibility of the scene"},
      {"F3", "screenshot, PNG"},
      {"Ctrl+R", "fly this flight again"},
      {"Shift+F10", "full screen, on and off"},
      {"Ctrl+U", "1000 ft higher"},
      {"Ctrl+H", "hold the heading; banking moves it"},
      {"Ctrl+A", "hold the height; the stick moves it"},
      {"Ctrl+S", "hold the speed; the throttle moves it"},
      {"Tab", "mouse: cursor, look, fly"},
      {"?", "show or hide the keys"}};
  for (const auto& [key, help] : keys) EXPECT_EQ(HelpOf(key, FlightMode::kAircraft), help) << key;
}

TEST(Action, LettersMoveTheFreeCameraWithAndWithoutShift) {
  const Action* forward = ActionOfKey(GLFW_KEY_W, 0, FlightMode::kFree);
  ASSERT_NE(forward, nullptr);
  EXPECT_EQ(forward->help, "fly forward");
  EXPECT_EQ(ActionOfKey(GLFW_KEY_W, GLFW_MOD_SHIFT, FlightMode::kFree), forward);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_A, GLFW_MOD_CONTROL, FlightMode::kFree), nullptr);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_T, GLFW_MOD_CAPS_LOCK, FlightMode::kFree),
            ActionOfKey(GLFW_KEY_T, 0, FlightMode::kFree))
      << "locks do not count";
  const Action* faster = ActionOfKey(GLFW_KEY_EQUAL, GLFW_MOD_SHIFT, FlightMode::kFree);
  ASSERT_NE(faster, nullptr);
  EXPECT_EQ(faster->help, "faster (also the mouse wheel)");
  EXPECT_EQ(ActionOfKey(GLFW_KEY_EQUAL, 0, FlightMode::kFree), faster);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_UNKNOWN, 0, FlightMode::kFree), nullptr);
}

TEST(Action, KeyTextsAreParsedAndOthersRefused) {
  EXPECT_EQ(KeyChordFromText("F12").key, GLFW_KEY_F12);
  EXPECT_EQ(KeyChordFromText("Keypad 0").key, GLFW_KEY_KP_0);
  EXPECT_EQ(KeyChordFromText("Ctrl+Shift+Q").modifiers, GLFW_MOD_SHIFT | GLFW_MOD_CONTROL);
  for (const char* text : {"", "F0", "F26", "Keypad 10", "w", "Ctrl+", "Hyper+W", "Page"}) {
    EXPECT_THROW(static_cast<void>(KeyChordFromText(text)), InputError) << text;
  }
}

TEST(Action, LettersAreThosePrintedOnTheKey) {
  EXPECT_EQ(PrintedKey(GLFW_KEY_W, "z"), GLFW_KEY_Z) << "a French keyboard";
  EXPECT_EQ(PrintedKey(GLFW_KEY_1, "&"), GLFW_KEY_1);
  EXPECT_EQ(PrintedKey(GLFW_KEY_KP_5, "5"), GLFW_KEY_KP_5) << "keypads are their own keys";
  EXPECT_EQ(PrintedKey(GLFW_KEY_F3, nullptr), GLFW_KEY_F3);
  EXPECT_EQ(PrintedKey(GLFW_KEY_X, "\xd1\x8f"), GLFW_KEY_X) << "a Russian keyboard";
}

// Each key of the help text of the program is one of the table.
TEST(Action, FirstKeysEqualThoseOfTheTable) {
  EXPECT_THAT(FirstKeysText(), HasSubstr("W: fly forward"));
  EXPECT_THAT(FirstKeysText(), HasSubstr("F5: next sunrise"));
}

TEST(Action, EffectsReportTheChange) {
  tests::RecordedCommands flight;
  EXPECT_EQ(flight.Press("K"), "exposure +0.3 EV");
  EXPECT_EQ(flight.Press("Ctrl+K"), "exposure follows the meter");
  EXPECT_EQ(flight.Press("L"), "exposure locked");
  EXPECT_EQ(flight.Press("L"), "exposure follows the meter");
  EXPECT_THAT(flight.Press("Shift+Z"), HasSubstr("visibility"));
  EXPECT_DOUBLE_EQ(flight.air_choice().aerosol, 1.25);
  flight.Press("Ctrl+Z");
  EXPECT_EQ(flight.air_choice().aerosol, 1.0);
  flight.Press("O");
  EXPECT_EQ(flight.quality().fixed, Quality::kLow) << "after automatic quality";
  flight.Press("Shift+F3");
  EXPECT_EQ(flight.requests.picture.value().extension, ".exr");
  flight.Press("H");
  EXPECT_EQ(flight.requests.parts.back(), WindowPart::kInstruments);
}

TEST(Action, TheManualShowsTheTable) {
  std::ifstream stream(std::string(tests::kSourceFolder) + "/viewer/MANUAL.md");
  const std::string manual{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(manual, HasSubstr(ControlsMarkdown())) << "put this into viewer/MANUAL.md:\n"
                                                     << ControlsMarkdown();
}

// --- pilot and clock under one hand ---

double FlatSea(const Place&) { return 0.0; }
double Airport(const Place&) { return 423.0; }

FlightController NewFlightController(const GroundHeight& ground = FlatSea) {
  return {{Place{47.0, 8.0, 1500.0}}, kWgs84, ParseInstant("2026-06-21T12:00:00Z"), ground};
}
std::string Shows(const FlightController& controller) {
  return FormatUtc(controller.clock().now());
}

TEST(FlightController, KeysChangeFlightAndTime) {
  RecordedCommands flight;
  EXPECT_EQ(flight.Press("T"), "time x10");
  EXPECT_EQ(flight.Press("Shift+]"), "");
  EXPECT_EQ(Shows(flight.controller()), "2026-06-21T13:00:00Z");
  EXPECT_EQ(flight.Press("F7"), "sunset");
  EXPECT_EQ(Shows(flight.controller()).substr(0, 13), "2026-06-21T19");
  EXPECT_EQ(flight.Press("F9"), "moonrise");
  EXPECT_EQ(flight.Press("3"), "there is no track to follow");
}

TEST(FlightController, CyclesThroughAvailableModes) {
  FlightController controller = NewFlightController();
  EXPECT_EQ(controller.EnterNext(1), "aircraft");
  EXPECT_EQ(controller.EnterNext(1), "free camera");
  EXPECT_EQ(controller.EnterNext(-1), "aircraft");
  EXPECT_EQ(controller.ToggleHold(Autopilot::Hold::kHeading), "HDG 000");
  EXPECT_EQ(controller.ReleaseAutopilot(), "autopilot off");
  EXPECT_EQ(controller.Enter(FlightMode::kFree), "free camera");
}

TEST(FlightController, PauseStopsTimeAndAircraftButNotTheFreeCamera) {
  RecordedCommands flight;
  FlightController& controller = flight.controller();
  EXPECT_EQ(flight.Press("P"), "paused");
  const double latitude = controller.pilot().eye().place.latitude_rad();
  controller.Advance({.camera = {.forward = 1.0}}, 1.0);
  EXPECT_GT(controller.pilot().eye().place.latitude_rad(), latitude);
  controller.Enter(FlightMode::kAircraft);
  const double stands = controller.pilot().eye().place.latitude_rad();
  controller.Advance({.look_right = 0.1}, 1.0);
  EXPECT_EQ(controller.pilot().eye().place.latitude_rad(), stands);
  EXPECT_GT(controller.pilot().eye().heading_rad, 0.05) << "one can look around";
  EXPECT_EQ(Shows(controller), "2026-06-21T12:00:00Z");
}

TEST(FlightController, FourfoldFlightSpeedAlsoSpeedsUpTheClock) {
  FlightController controller = NewFlightController();
  controller.Enter(FlightMode::kAircraft);
  EXPECT_EQ(controller.StepSpeed(1), "speed x2");
  EXPECT_EQ(controller.StepSpeed(1), "speed x4");
  controller.Advance({}, 2.5);
  EXPECT_EQ(Shows(controller), "2026-06-21T12:00:10Z");
}

TEST(FlightController, FliesToPlacesByName) {
  FlightController controller = NewFlightController();
  controller.GoTo(PlaceNamed("Matterhorn"));
  EXPECT_EQ(controller.pilot().eye().place.height_m, 100.0) << "over the ground that is there";
  FlightController at_airport = NewFlightController(Airport);
  at_airport.Enter(FlightMode::kAircraft);
  at_airport.GoTo(PlaceNamed("LSZH"));
  const FlightReadout readout = at_airport.pilot().Readout(Airport);
  EXPECT_EQ(readout.aircraft->contact, GroundContact::kStanding);
  EXPECT_NEAR(readout.aircraft->heading_rad / kRadiansPerDegree, 155.0, 1e-6);
}

TEST(FlightController, KeysTakeOffTurnAndClimbWithinAMinute) {
  RecordedCommands flight(Airport);
  FlightController& controller = flight.controller();
  Hands hands;
  controller.GoTo(PlaceNamed("LSZH"));
  const auto fly = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 1.0 / 30.0) {
      const Intent intent = hands.Interpret(controller.pilot().mode(), 1.0 / 30.0);
      for (const Action* action : intent.actions) action->run(flight);
      controller.Advance(intent.pilot, 1.0 / 30.0);
    }
  };
  const auto hold = [&](const char* key, double seconds) {
    hands.Key(KeyChordFromText(key).key, 1, 0);
    fly(seconds);
    hands.Key(KeyChordFromText(key).key, 0, 0);
  };
  hold("2", 0.1);
  hold("Page Up", 25.0);
  hold("Down", 0.8);
  fly(25.0);
  const FlightReadout climbing = controller.pilot().Readout(Airport);
  EXPECT_EQ(climbing.aircraft->contact, GroundContact::kNone);
  EXPECT_GT(climbing.above_ground_m, 50.0);
  EXPECT_FALSE(climbing.aircraft->stalled);
  ASSERT_TRUE(climbing.course);
  EXPECT_NEAR(climbing.course->heading_rad / kRadiansPerDegree, 155.0, 2.0);
  hold("Left", 0.6);
  fly(10.0);
  const FlightReadout turning = controller.pilot().Readout(Airport);
  EXPECT_LT(turning.aircraft->bank_rad, -10.0 * kRadiansPerDegree) << "held after the key is up";
  EXPECT_LT(turning.course->heading_rad, climbing.course->heading_rad - 0.2);
}

TEST(FlightController, LongFramesAdvanceByTheirWholeTime) {
  FlightController controller = NewFlightController();
  controller.Advance({}, 7.0);
  EXPECT_EQ(Shows(controller), "2026-06-21T12:00:07Z");
}

/// 10 s of the pilot that were an hour of the scene, with a narrow view.
std::shared_ptr<const CameraPath> AnHour() {
  CameraPose begin{Place{46.0, 8.0, 1000.0}}, end{Place{46.1, 8.0, 2000.0}};
  begin.fov_rad = end.fov_rad = 0.3;
  return std::make_shared<CameraPath>(
      std::vector<CameraPathPoint>{{0.0, begin, ParseInstant("2025-01-02T08:00:00Z")},
                                   {10.0, end, ParseInstant("2025-01-02T09:00:00Z")}});
}

TEST(FlightController, ReplayHasItsOwnTimeAndViewAndReturnsTheControls) {
  FlightController controller = NewFlightController();
  controller.clock().Pause(!controller.clock().paused());
  controller.Replay(AnHour());
  controller.Advance({}, 5.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:30:00Z") << "as fast as it went then";
  EXPECT_EQ(controller.pilot().eye().fov_rad, 0.3);
  EXPECT_EQ(controller.pilot().mode(), FlightMode::kTrack);
  controller.SkipTrack(-10.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:00Z");
  controller.clock().Pause(!controller.clock().paused());
  controller.Advance({}, 5.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:00Z") << "paused it stands";
  controller.clock().Pause(!controller.clock().paused());
  controller.Advance({}, 11.0);
  EXPECT_EQ(controller.pilot().mode(), FlightMode::kFree);
  EXPECT_NEAR(controller.pilot().eye().place.height_m, 2000.0, 1e-6);
  EXPECT_EQ(Shows(controller), "2025-01-02T09:00:00Z");
  controller.Advance({}, 1.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T09:00:01Z") << "real time again";
}

TEST(FlightController, ReplayOfThisFlightContinuesAtItsEnd) {
  FlightController controller = NewFlightController();
  controller.Enter(FlightMode::kAircraft);
  controller.ToggleHold(Autopilot::Hold::kHeading);
  controller.Advance({.stick = {.roll_right = 1.0}}, 3.0);
  const FlightReadout flown = controller.pilot().Readout(FlatSea);
  for (int time = 0; time < 2; ++time) {  // asked for in the middle, it begins again
    controller.FlyAgain(AnHour());
    EXPECT_TRUE(controller.pilot().Replays());
    controller.Advance({}, 5.0);
  }
  EXPECT_TRUE(controller.pilot().Replays());
  controller.Advance({}, 5.0);
  EXPECT_EQ(controller.pilot().mode(), FlightMode::kAircraft);
  const FlightReadout on = controller.pilot().Readout(FlatSea);
  EXPECT_EQ(on.aircraft->bank_rad, flown.aircraft->bank_rad);
  EXPECT_EQ(on.above_ground_m, flown.above_ground_m);
  EXPECT_EQ(on.autopilot, flown.autopilot);
}

TEST(FlightController, TimesOfATrackSetTheClockAlsoWhenSkipping) {
  FlightController controller = NewFlightController();
  controller.pilot().SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{
      {0.0, {Place{46.0, 8.0, 1000.0}}, ParseInstant("2025-01-02T08:00:00Z")},
      {100.0, {Place{46.1, 8.0, 2000.0}}, ParseInstant("2025-01-02T08:01:40Z")}}));
  EXPECT_EQ(controller.Enter(FlightMode::kTrack), "track");
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:00Z");
  controller.Advance({}, 5.0);
  controller.SkipTrack(10.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:15Z");
}

}  // namespace
}  // namespace alpenglow::viewer
