// SPDX-License-Identifier: MIT
#include "viewer/input/action.h"

// GLFW is included for its key numbers alone.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"

namespace alpenglow::viewer {
namespace {

static_assert(kShiftKey == GLFW_MOD_SHIFT && kControlKey == GLFW_MOD_CONTROL &&
              kAltKey == GLFW_MOD_ALT);

constexpr Modes kAll{true, true, true}, kFree{true, false, false}, kAircraft{false, true, false},
    kTrack{false, false, true}, kFlightController{false, true, true},
    kNotAircraft{true, false, true};
constexpr Press kOnce = Press::kOnce, kAgain = Press::kRepeating, kHeld = Press::kHeld;
constexpr std::string_view kAllKeys = "Everywhere", kCameraKeys = "Free camera",
                           kSpeedKeys = "Free camera and track", kTrackKeys = "Track",
                           kAircraftKeys = "Aircraft", kAutopilotKeys = "Autopilot of the aircraft",
                           kTimeKeys = "Time", kViewKeys = "View, air and light",
                           kExposureKeys = "Exposure", kCaptureKeys = "Capture and replay",
                           kWindowKeys = "Window";

constexpr ActionRow kActionRows[] = {
    {Action::kFreeMode, kOnce, kAll, kAllKeys, "free camera", "1, Ctrl+V", ""},
    {Action::kAircraftMode, kOnce, kAll, kAllKeys, "aircraft", "2", ""},
    {Action::kTrackMode, kOnce, kAll, kAllKeys, "follow the track", "3", ""},
    {Action::kNextMode, kOnce, kAll, kAllKeys, "next mode", "V", ""},
    {Action::kPreviousMode, kOnce, kAll, kAllKeys, "previous mode", "Shift+V", ""},
    {Action::kCentre, kOnce, kAll, kAllKeys, "centre the stick and look ahead, level",
     "5, Keypad 5", ""},
    {Action::kHigher, kOnce, kAll, kAllKeys, "1000 ft higher", "Ctrl+U", ""},
    {Action::kHud, kOnce, kAll, kWindowKeys, "hide everything but the picture", "H", ""},
    {Action::kNightTheme, kOnce, kAll, kWindowKeys, "colours for the night", "Shift+H", ""},
    {Action::kMouseMode, kOnce, kAll, kWindowKeys, "mouse: cursor, look, fly", "Tab", ""},
    {Action::kPanels, kOnce, kAll, kWindowKeys, "panels", "F10", ""},
    {Action::kFullScreen, kOnce, kAll, kWindowKeys, "full screen", "Shift+F10", ""},
    {Action::kHelp, kOnce, kAll, kWindowKeys, "these keys", "?, F1", ""},
    {Action::kQuit, kOnce, kAll, kWindowKeys, "close panels; ask whether to leave", "Esc", ""},
    {Action::kForward, kHeld, kFree, kCameraKeys, "fly forward", "W", ""},
    {Action::kBack, kHeld, kFree, kCameraKeys, "fly back", "S", ""},
    {Action::kLeft, kHeld, kFree, kCameraKeys, "fly to the left", "A", ""},
    {Action::kRight, kHeld, kFree, kCameraKeys, "fly to the right", "D", ""},
    {Action::kUp, kHeld, kFree, kCameraKeys, "rise", "R, Page Up", ""},
    {Action::kDown, kHeld, kFree, kCameraKeys, "sink", "F, Page Down", ""},
    {Action::kRollLeft, kHeld, kFree, kCameraKeys, "roll to the left", "Q", ""},
    {Action::kRollRight, kHeld, kFree, kCameraKeys, "roll to the right", "E", ""},
    {Action::kTurnLeft, kHeld, kFree, kCameraKeys, "turn to the left", "Left, Keypad 4", ""},
    {Action::kTurnRight, kHeld, kFree, kCameraKeys, "turn to the right", "Right, Keypad 6", ""},
    {Action::kLookUp, kHeld, kFree, kCameraKeys, "look up", "Up, Keypad 8", ""},
    {Action::kLookDown, kHeld, kFree, kCameraKeys, "look down", "Down, Keypad 2", ""},
    {Action::kFaster, kAgain, kNotAircraft, kSpeedKeys, "faster; the mouse wheel too",
     "+, Keypad +", ""},
    {Action::kSlower, kAgain, kNotAircraft, kSpeedKeys, "slower; the mouse wheel too",
     "-, Keypad -", ""},
    {Action::kTrackAhead, kAgain, kTrack, kTrackKeys, "ten seconds on along the track", "Right",
     ""},
    {Action::kTrackBack, kAgain, kTrack, kTrackKeys, "ten seconds back along the track", "Left",
     ""},
    {Action::kNoseDown, kHeld, kAircraft, kAircraftKeys, "stick forward: nose down", "Up, Keypad 8",
     ""},
    {Action::kNoseUp, kHeld, kAircraft, kAircraftKeys, "stick back: nose up", "Down, Keypad 2", ""},
    {Action::kBankLeft, kHeld, kAircraft, kAircraftKeys, "bank to the left", "Left, Keypad 4", ""},
    {Action::kBankRight, kHeld, kAircraft, kAircraftKeys, "bank to the right", "Right, Keypad 6",
     ""},
    {Action::kRudderLeft, kHeld, kAircraft, kAircraftKeys, "rudder to the left",
     "0, Keypad 0, Insert", ""},
    {Action::kRudderRight, kHeld, kAircraft, kAircraftKeys, "rudder to the right",
     "Enter, Keypad Enter", ""},
    {Action::kThrottleUp, kHeld, kAircraft, kAircraftKeys, "more throttle", "Page Up, Keypad 9, 9",
     ""},
    {Action::kThrottleDown, kHeld, kAircraft, kAircraftKeys, "less throttle", "Page Down, Keypad 3",
     ""},
    {Action::kBrake, kHeld, kAircraft, kAircraftKeys, "brakes of the wheels", "B", ""},
    {Action::kFasterFlight, kOnce, kAircraft, kAircraftKeys, "flight twice as fast, up to 32 times",
     "A", ""},
    {Action::kSlowerFlight, kOnce, kAircraft, kAircraftKeys,
     "flight half as fast, down to real time", "Shift+A", ""},
    {Action::kHoldHeading, kOnce, kAircraft, kAutopilotKeys, "hold the heading; banking moves it",
     "Ctrl+H", ""},
    {Action::kHoldAltitude, kOnce, kAircraft, kAutopilotKeys, "hold the height; the stick moves it",
     "Ctrl+A", ""},
    {Action::kHoldClimb, kOnce, kAircraft, kAutopilotKeys, "hold the climb; the stick moves it",
     "Ctrl+P", ""},
    {Action::kHoldSpeed, kOnce, kAircraft, kAutopilotKeys, "hold the speed; the throttle moves it",
     "Ctrl+S", ""},
    {Action::kLevelWings, kOnce, kAircraft, kAutopilotKeys, "keep the wings level", "Ctrl+W", ""},
    {Action::kAutopilotOff, kOnce, kAircraft, kAutopilotKeys, "hold nothing", "Backspace", ""},
    {Action::kExposureLock, kOnce, kAll, kExposureKeys, "lock the exposure", "L", ""},
    {Action::kBrighter, kAgain, kAll, kExposureKeys, "a third of a stop brighter", "K", ""},
    {Action::kDarker, kAgain, kAll, kExposureKeys, "a third of a stop darker", "Shift+K", ""},
    {Action::kResetExposure, kOnce, kAll, kExposureKeys, "exposure of the meter", "Ctrl+K", ""},
    {Action::kNarrowerView, kAgain, kAll, kViewKeys, "narrower view (aircraft: wheel too)", "X",
     ""},
    {Action::kWiderView, kAgain, kAll, kViewKeys, "wider view (aircraft: wheel too)", "Shift+X",
     ""},
    {Action::kResetView, kOnce, kAll, kViewKeys, "view that the scene began with", "Ctrl+X", ""},
    {Action::kClearer, kAgain, kAll, kViewKeys, "farther visibility", "Z", ""},
    {Action::kHazier, kAgain, kAll, kViewKeys, "shorter visibility", "Shift+Z", ""},
    {Action::kResetVisibility, kOnce, kAll, kViewKeys, "visibility of the scene", "Ctrl+Z", ""},
    {Action::kLandingLight, kOnce, kAll, kViewKeys, "landing light on and off", "Ctrl+L", ""},
    {Action::kNextQuality, kOnce, kAll, kViewKeys, "next quality", "O", ""},
    {Action::kPause, kOnce, kAll, kTimeKeys, "pause: time, aircraft and track stand", "P", ""},
    {Action::kFasterTime, kAgain, kAll, kTimeKeys, "rate of time up: -3600 to 3600", "T", ""},
    {Action::kSlowerTime, kAgain, kAll, kTimeKeys, "rate of time down, and backwards", "Shift+T",
     ""},
    {Action::kRealTime, kOnce, kAll, kTimeKeys, "real time", "Shift+P", ""},
    {Action::kLaterMinute, kAgain, kAll, kTimeKeys, "a minute later", "]", "W"},
    {Action::kEarlierMinute, kAgain, kAll, kTimeKeys, "a minute earlier", "[", "Shift+W"},
    {Action::kLaterHour, kAgain, kAll, kTimeKeys, "an hour later", "Shift+]", ""},
    {Action::kEarlierHour, kAgain, kAll, kTimeKeys, "an hour earlier", "Shift+[", ""},
    {Action::kLaterDay, kAgain, kAll, kTimeKeys, "a day later", "Ctrl+]", ""},
    {Action::kEarlierDay, kAgain, kAll, kTimeKeys, "a day earlier", "Ctrl+[", ""},
    {Action::kToDawn, kOnce, kAll, kTimeKeys, "on to dawn", "Shift+F5", ""},
    {Action::kToSunrise, kOnce, kAll, kTimeKeys, "on to sunrise", "F5", ""},
    {Action::kToNoon, kOnce, kAll, kTimeKeys, "on to noon", "F6", ""},
    {Action::kToSunset, kOnce, kAll, kTimeKeys, "on to sunset", "F7", ""},
    {Action::kToDusk, kOnce, kAll, kTimeKeys, "on to dusk", "F8", ""},
    {Action::kToMoonrise, kOnce, kAll, kTimeKeys, "on to moonrise", "F9", ""},
    {Action::kToMoonset, kOnce, kAll, kTimeKeys, "on to moonset", "Shift+F9", ""},
    {Action::kScreenshot, kOnce, kAll, kCaptureKeys, "screenshot, PNG", "F3", ""},
    {Action::kScreenshotExr, kOnce, kAll, kCaptureKeys, "screenshot, linear EXR", "Shift+F3", ""},
    {Action::kSaveFlight, kOnce, kAll, kCaptureKeys, "write the flight so far to a file",
     "Shift+F2", ""},
    {Action::kReplay, kOnce, kAll, kCaptureKeys, "fly this flight again", "Ctrl+R", ""},
};

constexpr std::pair<std::string_view, int> kKeyNames[] = {
    {"Up", GLFW_KEY_UP},
    {"Down", GLFW_KEY_DOWN},
    {"Left", GLFW_KEY_LEFT},
    {"Right", GLFW_KEY_RIGHT},
    {"Page Up", GLFW_KEY_PAGE_UP},
    {"Page Down", GLFW_KEY_PAGE_DOWN},
    {"Insert", GLFW_KEY_INSERT},
    {"Enter", GLFW_KEY_ENTER},
    {"Backspace", GLFW_KEY_BACKSPACE},
    {"Tab", GLFW_KEY_TAB},
    {"Esc", GLFW_KEY_ESCAPE},
    {"Keypad Enter", GLFW_KEY_KP_ENTER},
    {"Keypad +", GLFW_KEY_KP_ADD},
    {"Keypad -", GLFW_KEY_KP_SUBTRACT},
    {"[", GLFW_KEY_LEFT_BRACKET},
    {"]", GLFW_KEY_RIGHT_BRACKET},
    {"-", GLFW_KEY_MINUS},
};

bool IsLetterOrDigit(char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// Returns the key of "F3" or "Keypad 9": a word and a number.
std::optional<int> NumberedKey(std::string_view name) {
  const auto number = [&](std::string_view word) -> std::optional<int> {
    if (!name.starts_with(word) || name.size() == word.size()) return std::nullopt;
    int value = 0;
    for (const char c : name.substr(word.size())) {
      if (c < '0' || c > '9') return std::nullopt;
      value = 10 * value + (c - '0');
    }
    return value;
  };
  if (const auto digit = number("Keypad "); digit && *digit <= 9) return GLFW_KEY_KP_0 + *digit;
  if (const auto f = number("F"); f && *f >= 1 && *f <= 25) return GLFW_KEY_F1 + *f - 1;
  return std::nullopt;
}

std::optional<int> KeyFromName(std::string_view name) {
  // GLFW numbers letters and digits as in ASCII.
  if (name.size() == 1 && IsLetterOrDigit(name[0])) return name[0];
  for (const auto& [known, key] : kKeyNames) {
    if (known == name) return key;
  }
  return NumberedKey(name);
}

std::vector<std::string_view> SplitAtCommas(std::string_view keys) {
  std::vector<std::string_view> parts;
  while (!keys.empty()) {
    const std::size_t comma = std::min(keys.find(", "), keys.size());
    parts.push_back(keys.substr(0, comma));
    keys.remove_prefix(std::min(comma + 2, keys.size()));
  }
  return parts;
}

struct Binding {
  KeyChord chord;
  const ActionRow* row;
  Modes modes;
};

std::vector<Binding> AllBindings() {
  std::vector<Binding> bindings;
  for (const ActionRow& row : kActionRows) {
    for (const std::string_view key : SplitAtCommas(row.keys))
      bindings.push_back({KeyChordFromText(key), &row, row.modes});
    for (const std::string_view key : SplitAtCommas(row.keys_in_cockpit))
      bindings.push_back({KeyChordFromText(key), &row, kFlightController});
  }
  return bindings;
}

bool Fits(const Binding& binding, int key, int modifiers, FlightMode mode) {
  if (binding.chord.key != key || !binding.modes.Has(mode)) return false;
  const bool any_shift = binding.chord.any_shift || binding.row->press == Press::kHeld;
  const int counted = any_shift ? modifiers & ~kShiftKey : modifiers;
  return counted == binding.chord.modifiers;
}

}  // namespace

bool Modes::Has(FlightMode mode) const {
  return mode == FlightMode::kFree ? free : mode == FlightMode::kAircraft ? aircraft : track;
}

std::span<const ActionRow> ActionTable() { return kActionRows; }

const ActionRow& RowOf(Action action) {
  const ActionRow& row = kActionRows[static_cast<std::size_t>(action)];
  ALPENGLOW_ENSURE(static_cast<int>(row.action), ==, static_cast<int>(action));
  return row;
}

std::vector<ActionSection> ActionSections() {
  std::vector<ActionSection> sections;
  for (const ActionRow& row : kActionRows) {
    if (sections.empty() || sections.back().heading != row.heading)
      sections.push_back({row.heading, {&row, 0}});
    std::span<const ActionRow>& rows = sections.back().rows;
    rows = {rows.data(), rows.size() + 1};
  }
  return sections;
}

KeyChord KeyChordFromText(std::string_view text) {
  if (text == "+") return {GLFW_KEY_EQUAL, 0, true};
  if (text == "?") return {GLFW_KEY_SLASH, kShiftKey};
  int modifiers = 0;
  std::string_view name = text;
  for (const auto& [word, modifier] : {std::pair<std::string_view, int>{"Ctrl+", kControlKey},
                                       {"Shift+", kShiftKey},
                                       {"Alt+", kAltKey}}) {
    if (!name.starts_with(word)) continue;
    modifiers |= modifier;
    name.remove_prefix(word.size());
  }
  const std::optional<int> key = KeyFromName(name);
  if (!key) throw InputError(fmt::format("\"{}\" is no key", text));
  return {*key, modifiers};
}

std::optional<Action> ActionOfKey(int key, int modifiers, FlightMode mode) {
  static const std::vector<Binding> bindings = AllBindings();
  // Caps Lock and Num Lock are modifiers too; ignore them.
  const int counted = modifiers & (kShiftKey | kControlKey | kAltKey);
  for (const Binding& binding : bindings) {
    if (Fits(binding, key, counted, mode)) return binding.row->action;
  }
  return std::nullopt;
}

int PrintedKey(int key, const char* name) {
  if (name == nullptr || name[0] == '\0' || name[1] != '\0') return key;
  const char c =
      name[0] >= 'a' && name[0] <= 'z' ? static_cast<char>(name[0] - 'a' + 'A') : name[0];
  const bool keypad = key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_EQUAL;
  return !keypad && IsLetterOrDigit(c) ? c : key;
}

std::string KeysText(const ActionRow& row) {
  if (row.keys_in_cockpit.empty()) return std::string(row.keys);
  return fmt::format("{}; {} (aircraft, track)", row.keys, row.keys_in_cockpit);
}

std::string ControlsMarkdown() {
  std::string text = "| | keys | what they do |\n|---|---|---|\n";
  for (const ActionSection& section : ActionSections()) {
    for (const ActionRow& row : section.rows) {
      const bool is_first = &row == section.rows.data();
      text += fmt::format("| {} | {} | {} |\n", is_first ? section.heading : "", KeysText(row),
                          row.does);
    }
  }
  return text;
}

}  // namespace alpenglow::viewer
