// SPDX-License-Identifier: MIT
// What a pilot can ask for, and with which keys: one table, read by the keyboard, by the help on
// the screen and by the manual.
//
// Keys are FlightGear's where it has them (its keyboard.xml); in the free camera W A S D, R F and
// Q E move the eye, as in other viewers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

enum class Action {
  // Modes, and where the eye is.
  kFreeMode,
  kAircraftMode,
  kTrackMode,
  kNextMode,
  kPreviousMode,
  kCentre,
  kHigher,
  // The window.
  kHud,
  kNightTheme,
  kMouseMode,
  kPanels,
  kFullScreen,
  kHelp,
  kQuit,
  // The eye of the free camera, while a key is held.
  kForward,
  kBack,
  kLeft,
  kRight,
  kUp,
  kDown,
  kRollLeft,
  kRollRight,
  kTurnLeft,
  kTurnRight,
  kLookUp,
  kLookDown,
  // Speed of free camera and track.
  kFaster,
  kSlower,
  // The place along the track.
  kTrackAhead,
  kTrackBack,
  // The aircraft, most of them while a key is held.
  kNoseDown,
  kNoseUp,
  kBankLeft,
  kBankRight,
  kRudderLeft,
  kRudderRight,
  kThrottleUp,
  kThrottleDown,
  kBrake,
  kFasterFlight,
  kSlowerFlight,
  // The autopilot.
  kHoldHeading,
  kHoldAltitude,
  kHoldClimb,
  kHoldSpeed,
  kLevelWings,
  kAutopilotOff,
  // Exposure.
  kExposureLock,
  kBrighter,
  kDarker,
  kResetExposure,
  // The view, the air and lights.
  kNarrowerView,
  kWiderView,
  kResetView,
  kClearer,
  kHazier,
  kResetVisibility,
  kLandingLight,
  kNextQuality,
  // Time.
  kPause,
  kFasterTime,
  kSlowerTime,
  kRealTime,
  kLaterMinute,
  kEarlierMinute,
  kLaterHour,
  kEarlierHour,
  kLaterDay,
  kEarlierDay,
  kToDawn,
  kToSunrise,
  kToNoon,
  kToSunset,
  kToDusk,
  kToMoonrise,
  kToMoonset,
  // Pictures and flights in files.
  kScreenshot,
  kScreenshotExr,
  kSaveFlight,
  kReplay,
};

/// In which flight modes a key does something.
struct Modes {
  bool free, aircraft, track;
  [[nodiscard]] bool Has(FlightMode mode) const;
};

/// How a key acts: once when it goes down; again while the keyboard repeats it; as long as it is
/// held.
enum class Press { kOnce, kRepeating, kHeld };

/// One line of the table.
struct ActionRow {
  Action action;
  Press press;
  Modes modes;
  std::string_view heading, does;
  std::string_view keys;             // "Page Up, Keypad 9"
  std::string_view keys_in_cockpit;  // keys that it has with aircraft and track alone
};

/// All lines, an action each, in the order of the enumeration.
[[nodiscard]] std::span<const ActionRow> ActionTable();
[[nodiscard]] const ActionRow& RowOf(Action action);

/// The lines under one heading.
struct ActionSection {
  std::string_view heading;
  std::span<const ActionRow> rows;
};
/// All lines: first what works everywhere, then mode by mode, then what is seen.
[[nodiscard]] std::vector<ActionSection> ActionSections();

/// Modifiers, as GLFW counts them.
inline constexpr int kShiftKey = 1, kControlKey = 2, kAltKey = 4;

/// A key with its modifiers. Keys are GLFW's numbers.
struct KeyChord {
  int key;
  int modifiers;
  bool any_shift = false;  // "+" is "=" with or without Shift
};
/// "Shift+T", "Ctrl+H", "Page Up", "?". Throws InputError for a key that it does not know.
[[nodiscard]] KeyChord KeyChordFromText(std::string_view text);

/// What a key does in a mode; nothing for most keys. Held keys act with Shift too, not with Ctrl or
/// Alt.
[[nodiscard]] std::optional<Action> ActionOfKey(int key, int modifiers, FlightMode mode);

/// The number of the key that a keyboard prints `name` on (glfwGetKeyName): letters stand elsewhere
/// on a French keyboard. `key` itself where the name is no letter and no digit.
[[nodiscard]] int PrintedKey(int key, const char* name);

/// "T, Keypad 9": all keys of a line.
[[nodiscard]] std::string KeysText(const ActionRow& row);

/// The table for the manual.
[[nodiscard]] std::string ControlsMarkdown();

}  // namespace alpenglow::viewer
