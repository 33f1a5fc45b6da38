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

namespace alpenglow::viewer {
namespace {

using ::testing::HasSubstr;

constexpr FlightMode kModes[] = {FlightMode::kFree, FlightMode::kAircraft, FlightMode::kTrack};

TEST(Action, EveryActionHasItsLineInTheTable) {
  const auto table = ActionTable();
  EXPECT_EQ(table.back().action, Action::kReplay) << "the last of the enumeration";
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(table[i].action), i) << table[i].does;
    EXPECT_EQ(RowOf(table[i].action).does, table[i].does);
    EXPECT_FALSE(table[i].keys.empty()) << table[i].does;
  }
}

/// All keys that the table names: chord, row, and whether in the flight controller alone.
template <typename Visit>
void ForEachKey(const Visit& visit) {
  for (const ActionRow& row : ActionTable()) {
    for (const bool cockpit : {false, true}) {
      std::string keys(cockpit ? row.keys_in_cockpit : row.keys);
      for (std::size_t begin = 0; begin < keys.size();) {
        const std::size_t end = std::min(keys.find(", ", begin), keys.size());
        visit(keys.substr(begin, end - begin), row, cockpit);
        begin = end + 2;
      }
    }
  }
}

TEST(Action, EveryKeyOfTheTableDoesWhatItsLineSaysAndNoneDoesTwoThings) {
  int keys = 0;
  ForEachKey([&](const std::string& text, const ActionRow& row, bool cockpit) {
    const KeyChord chord = KeyChordFromText(text);
    for (const FlightMode mode : kModes) {
      if (!row.modes.Has(mode) || (cockpit && mode == FlightMode::kFree)) continue;
      const auto action = ActionOfKey(chord.key, chord.modifiers, mode);
      ASSERT_TRUE(action) << text;
      EXPECT_EQ(RowOf(*action).does, row.does) << text << " in mode " << static_cast<int>(mode);
      ++keys;
    }
  });
  EXPECT_GT(keys, 150);
}

TEST(Action, NoKeyIsListedTwiceForOneMode) {
  for (const FlightMode mode : kModes) {
    std::vector<std::pair<int, int>> chords;
    ForEachKey([&](const std::string& text, const ActionRow& row, bool cockpit) {
      if (!row.modes.Has(mode) || (cockpit && mode == FlightMode::kFree)) return;
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
  std::vector<Action> listed;
  for (const ActionSection& section : ActionSections()) {
    headings.push_back(section.heading);
    for (const ActionRow& row : section.rows) {
      EXPECT_EQ(row.heading, section.heading) << row.does;
      EXPECT_EQ(row.modes.free, section.rows.front().modes.free) << row.does;
      EXPECT_EQ(row.modes.aircraft, section.rows.front().modes.aircraft) << row.does;
      EXPECT_EQ(row.modes.track, section.rows.front().modes.track) << row.does;
      actions.push_back(row.does);
      listed.push_back(row.action);
    }
  }
  EXPECT_EQ(listed.size(), static_cast<std::size_t>(Action::kReplay) + 1);
  for (std::size_t i = 0; i < listed.size(); ++i)
    EXPECT_EQ(static_cast<std::size_t>(listed[i]), i) << actions[i];
  for (std::vector<std::string_view>* texts : {&headings, &actions}) {
    std::sort(texts->begin(), texts->end());
    const auto twice = std::adjacent_find(texts->begin(), texts->end());
    EXPECT_EQ(twice, texts->end()) << *twice;
  }
}

TEST(Action, KeysAreThoseOfFlightGear) {
  const auto aircraft = [](const char* text) {
    const KeyChord chord = KeyChordFromText(text);
    return ActionOfKey(chord.key, chord.modifiers, FlightMode::kAircraft);
  };
  EXPECT_EQ(aircraft("Up"), Action::kNoseDown) << "elevator down";
  EXPECT_EQ(aircraft("Keypad 2"), Action::kNoseUp);
  EXPECT_EQ(aircraft("Keypad 5"), Action::kCentre);
  EXPECT_EQ(aircraft("9"), Action::kThrottleUp);
  EXPECT_EQ(aircraft("Page Down"), Action::kThrottleDown);
  EXPECT_EQ(aircraft("0"), Action::kRudderLeft);
  EXPECT_EQ(aircraft("Enter"), Action::kRudderRight);
  EXPECT_EQ(aircraft("P"), Action::kPause);
  EXPECT_EQ(aircraft("A"), Action::kFasterFlight);
  EXPECT_EQ(aircraft("Shift+A"), Action::kSlowerFlight);
  EXPECT_EQ(aircraft("T"), Action::kFasterTime);
  EXPECT_EQ(aircraft("W"), Action::kLaterMinute);
  EXPECT_EQ(aircraft("Shift+W"), Action::kEarlierMinute);
  EXPECT_EQ(aircraft("X"), Action::kNarrowerView);
  EXPECT_EQ(aircraft("Ctrl+X"), Action::kResetView);
  EXPECT_EQ(aircraft("Z"), Action::kClearer);
  EXPECT_EQ(aircraft("Ctrl+Z"), Action::kResetVisibility);
  EXPECT_EQ(aircraft("F3"), Action::kScreenshot);
  EXPECT_EQ(aircraft("Ctrl+R"), Action::kReplay);
  EXPECT_EQ(aircraft("Shift+F10"), Action::kFullScreen);
  EXPECT_EQ(aircraft("Ctrl+U"), Action::kHigher);
  EXPECT_EQ(aircraft("Ctrl+H"), Action::kHoldHeading);
  EXPECT_EQ(aircraft("Ctrl+A"), Action::kHoldAltitude);
  EXPECT_EQ(aircraft("Ctrl+S"), Action::kHoldSpeed);
  EXPECT_EQ(aircraft("Tab"), Action::kMouseMode);
  EXPECT_EQ(aircraft("?"), Action::kHelp);
}

TEST(Action, InTheFreeCameraLettersMoveTheEyeWithAndWithoutShift) {
  EXPECT_EQ(ActionOfKey(GLFW_KEY_W, 0, FlightMode::kFree), Action::kForward);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_W, GLFW_MOD_SHIFT, FlightMode::kFree), Action::kForward);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_A, GLFW_MOD_CONTROL, FlightMode::kFree), std::nullopt);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_T, GLFW_MOD_CAPS_LOCK, FlightMode::kFree), Action::kFasterTime)
      << "locks do not count";
  EXPECT_EQ(ActionOfKey(GLFW_KEY_EQUAL, GLFW_MOD_SHIFT, FlightMode::kFree), Action::kFaster);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_EQUAL, 0, FlightMode::kFree), Action::kFaster);
  EXPECT_EQ(ActionOfKey(GLFW_KEY_UNKNOWN, 0, FlightMode::kFree), std::nullopt);
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

TEST(Action, TheManualShowsTheTable) {
  std::ifstream stream(std::string(tests::kSourceFolder) + "/viewer/MANUAL.md");
  const std::string manual{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(manual, HasSubstr(ControlsMarkdown())) << "put this into viewer/MANUAL.md:\n"
                                                     << ControlsMarkdown();
}

}  // namespace
}  // namespace alpenglow::viewer
