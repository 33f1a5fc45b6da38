// SPDX-License-Identifier: MIT
// Actions of the pilot and their keys: one table for the keyboard, the help on the screen and the
// manual.
//
// Keys follow FlightGear where it defines them (its keyboard.xml); in the free camera W A S D, R F
// and Q E move the eye, as in other viewers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

enum class Action {
  // Modes, and the position of the eye.
  kFreeMode,
  kAircraftMode,
  kTrackMode,
  kNextMode,
  kPreviousMode,
  kCentre,
  kHigher,
  // Window.
  kHud,
  kNightTheme,
  kMouseMode,
  kPanels,
  kFullScreen,
  kHelp,
  kQuit,
  // Eye of the free camera, while a key is held.
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
  // Position along the track.
  kTrackAhead,
  kTrackBack,
  // Aircraft, mostly while a key is held.
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
  // Autopilot.
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
  // View, air and lights.
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
  // Picture and flight files.
  kScreenshot,
  kScreenshotExr,
  kSaveFlight,
  kReplay,
};

/// Flight modes in which a key has an effect.
struct Modes {
  bool free, aircraft, track;
  [[nodiscard]] bool Has(FlightMode mode) const;
};

/// Trigger of a key: once when it goes down; also on keyboard repeats; as long as it is held.
enum class Press { kOnce, kRepeating, kHeld };

/// One line of the table.
struct ActionRow {
  Action action;
  Press press;
  Modes modes;
  std::string_view heading, does;
  std::string_view keys;             // "Page Up, Keypad 9"
  std::string_view keys_in_cockpit;  // additional keys in aircraft and track modes
};

/// Returns all lines, one action each, in the order of the enumeration.
[[nodiscard]] std::span<const ActionRow> ActionTable();
[[nodiscard]] const ActionRow& RowOf(Action action);

/// The lines under one heading.
struct ActionSection {
  std::string_view heading;
  std::span<const ActionRow> rows;
};
/// Returns all lines: first the actions of all modes, then those of each mode, then those of the view.
[[nodiscard]] std::vector<ActionSection> ActionSections();

/// Modifiers with GLFW's values.
inline constexpr int kShiftKey = 1, kControlKey = 2, kAltKey = 4;

/// A key with its modifiers. Keys are GLFW's numbers.
struct KeyChord {
  int key;
  int modifiers;
  bool any_shift = false;  // "+" is "=" with or without Shift
};
/// Parses "Shift+T", "Ctrl+H", "Page Up", "?". Throws InputError for an unknown key.
[[nodiscard]] KeyChord KeyChordFromText(std::string_view text);

/// Returns the action of a key in a mode; no value for most keys. Held keys also act with Shift,
/// but not with Ctrl or Alt.
[[nodiscard]] std::optional<Action> ActionOfKey(int key, int modifiers, FlightMode mode);

/// Returns the number of the key with the label `name` on the keyboard (glfwGetKeyName): letters
/// have other positions on a French keyboard. Returns `key` if the name is neither a letter nor a
/// digit.
[[nodiscard]] int PrintedKey(int key, const char* name);

/// Returns "T, Keypad 9": all keys of a line.
[[nodiscard]] std::string KeysText(const ActionRow& row);

/// Returns the table for the manual.
[[nodiscard]] std::string ControlsMarkdown();

}  // namespace alpenglow::viewer
