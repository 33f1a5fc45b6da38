// SPDX-License-Identifier: MIT
#include "viewer/input/action.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "atmosphere/base/error.h"
#include "tests/fixtures/places.h"
#include "tests/viewer/input/recorded_commands.h"

namespace alpenglow::viewer {
namespace {

using ::testing::HasSubstr;

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

/// All keys that the table names: chord, row, and whether in the flight controller alone.
template <typename Visit>
void ForEachKey(const Visit& visit) {
  for (const Action& row : ActionTable()) {
    for (const bool controller : {false, true}) {
      std::string keys(controller ? row.keys_in_cockpit : row.keys);
      for (std::size_t begin = 0; begin < keys.size();) {
        const std::size_t end = std::min(keys.find(", ", begin), keys.size());
        visit(keys.substr(begin, end - begin), row, controller);
        begin = end + 2;
      }
    }
  }
}

TEST(Action, EveryKeyOfTheTableDoesWhatItsLineSaysAndNoneDoesTwoThings) {
  int keys = 0;
  ForEachKey([&](const std::string& text, const Action& row, bool controller) {
    const KeyChord chord = KeyChordFromText(text);
    for (const FlightMode mode : kModes) {
      if (!row.modes.Has(mode) || (controller && mode == FlightMode::kFree)) continue;
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
    ForEachKey([&](const std::string& text, const Action& row, bool controller) {
      if (!row.modes.Has(mode) || (controller && mode == FlightMode::kFree)) return;
      const KeyChord chord = KeyChordFromText(text);
      const std::pair<int, int> pair{chord.key, chord.modifiers};
      EXPECT_THAT(chords, ::testing::Not(::testing::Contains(pair)))
          << text << " in mode " << static_cast<int>(mode);
      chords.push_back(pair);
    });
  }
}

TEST(Action, SectionsHaveEveryActionOnceUnderAHeadingOfItsOwn) {
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

TEST(Action, KeysAreThoseOfFlightGear) {
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

TEST(Action, InTheFreeCameraLettersMoveTheEyeWithAndWithoutShift) {
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

TEST(Action, KeyTextsAreReadAndOthersRefused) {
  EXPECT_EQ(KeyChordFromText("F12").key, GLFW_KEY_F12);
  EXPECT_EQ(KeyChordFromText("Keypad 0").key, GLFW_KEY_KP_0);
  EXPECT_EQ(KeyChordFromText("Ctrl+Shift+Q").modifiers, GLFW_MOD_SHIFT | GLFW_MOD_CONTROL);
  for (const char* text : {"", "F0", "F26", "Keypad 10", "w", "Ctrl+", "Hyper+W", "Page"}) {
    EXPECT_THROW(static_cast<void>(KeyChordFromText(text)), InputError) << text;
  }
}

TEST(Action, LettersGoByWhatIsPrintedOnTheKey) {
  EXPECT_EQ(PrintedKey(GLFW_KEY_W, "z"), GLFW_KEY_Z) << "a French keyboard";
  EXPECT_EQ(PrintedKey(GLFW_KEY_1, "&"), GLFW_KEY_1);
  EXPECT_EQ(PrintedKey(GLFW_KEY_KP_5, "5"), GLFW_KEY_KP_5) << "keypads are their own keys";
  EXPECT_EQ(PrintedKey(GLFW_KEY_F3, nullptr), GLFW_KEY_F3);
  EXPECT_EQ(PrintedKey(GLFW_KEY_X, "\xd1\x8f"), GLFW_KEY_X) << "a Russian keyboard";
}

// Each key of the help text of the program is one of the table.
TEST(Action, TheFirstKeysAreThoseOfTheTable) {
  EXPECT_THAT(FirstKeysText(), HasSubstr("W: fly forward"));
  EXPECT_THAT(FirstKeysText(), HasSubstr("F5: next sunrise"));
}

TEST(Action, EffectsReportWhatTheyChange) {
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
  EXPECT_TRUE(flight.requests.picture.value().is_exr);
  flight.Press("H");
  EXPECT_EQ(flight.requests.parts.back(), WindowPart::kInstruments);
}

TEST(Action, TheManualShowsTheTable) {
  std::ifstream stream(std::string(tests::kSourceFolder) + "/viewer/MANUAL.md");
  const std::string manual{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(manual, HasSubstr(ControlsMarkdown())) << "put this into viewer/MANUAL.md:\n"
                                                     << ControlsMarkdown();
}

}  // namespace
}  // namespace alpenglow::viewer
