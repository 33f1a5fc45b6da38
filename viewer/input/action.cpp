// SPDX-License-Identifier: MIT
#include "viewer/input/action.h"

// GLFW is included for its key numbers alone.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/scene/scene_clouds.h"

namespace alpenglow::viewer {
namespace {

static_assert(kShiftKey == GLFW_MOD_SHIFT && kControlKey == GLFW_MOD_CONTROL &&
              kAltKey == GLFW_MOD_ALT);

constexpr Modes kAll{true, true, true}, kFree{true, false, false}, kAircraft{false, true, false},
    kTrack{false, false, true}, kNotFree{false, true, true}, kNotAircraft{true, false, true};
constexpr std::string_view kAllKeys = "Everywhere", kCameraKeys = "Free camera",
                           kSpeedKeys = "Free camera and track", kTrackKeys = "Track",
                           kAircraftKeys = "Aircraft", kAutopilotKeys = "Autopilot of the aircraft",
                           kTimeKeys = "Time", kViewKeys = "View, air and light",
                           kExposureKeys = "Exposure", kCaptureKeys = "Capture and replay",
                           kWindowKeys = "Window";

using Run = void (*)(FlightCommands& flight);

// Lines of the table: an action of a press, an action that repeats while its key is held, and a
// control that moves while its key is held.
constexpr Action Once(std::string_view heading, std::string_view help, std::string_view keys,
                      Run run, Modes modes = kAll) {
  return {heading, help, keys, Press::kOnce, modes, run};
}
constexpr Action Again(std::string_view heading, std::string_view help, std::string_view keys,
                       Run run, Modes modes = kAll) {
  return {heading, help, keys, Press::kRepeating, modes, run};
}
constexpr Action Moves(std::string_view help, std::string_view keys, double Steering::*control,
                       double sign) {
  return {kCameraKeys, help, keys, Press::kHeld, kFree, nullptr, {control, nullptr, sign}};
}
constexpr Action Moves(std::string_view help, std::string_view keys, double Stick::*control,
                       double sign) {
  return {kAircraftKeys, help, keys, Press::kHeld, kAircraft, nullptr, {nullptr, control, sign}};
}
// Additional triggers of a line.
constexpr Action OnPad(int button, Action action, Modes modes = kAll) {
  action.pad = {button, modes};
  return action;
}
constexpr Action OnWheel(int step, Action action) {
  action.wheel = step;
  return action;
}
constexpr Action OutsideFreeCamera(std::string_view keys, Action action) {
  action.keys_outside_free_camera = keys;
  return action;
}
constexpr Action NeedsPicture(Action action) {
  action.needs_picture = true;
  return action;
}

template <FlightMode kMode>
void Enter(FlightCommands& flight) {
  flight.Report(flight.controller().Enter(kMode));
}
template <int kStep>
void EnterNext(FlightCommands& flight) {
  flight.Report(flight.controller().EnterNext(kStep));
}
template <WindowPart kPart>
void Switch(FlightCommands& flight) {
  flight.Switch(kPart);
}
template <int kStep>
void StepSpeed(FlightCommands& flight) {
  flight.Report(flight.controller().StepSpeed(kStep));
}
template <int kSeconds>
void SkipTrack(FlightCommands& flight) {
  flight.controller().SkipTrack(kSeconds);
}
template <Autopilot::Hold kHold>
void Hold(FlightCommands& flight) {
  flight.Report(flight.controller().ToggleHold(kHold));
}
// Brightens by thirds of a stop.
template <int kThirds>
void Compensate(FlightCommands& flight) {
  ExposureControl& exposure = flight.exposure();
  exposure.Compensate(exposure.exposure().compensation_ev + kThirds / 3.0);
  flight.Report(fmt::format("exposure {:+.1f} EV", exposure.exposure().compensation_ev));
}
template <int kStep>
void Zoom(FlightCommands& flight) {
  constexpr double kZoomStep = 1.1;
  flight.controller().pilot().Zoom(kStep > 0 ? kZoomStep : 1.0 / kZoomStep);
}
template <int kSeconds>
void Shift(FlightCommands& flight) {
  flight.controller().clock().Shift(kSeconds);
}
template <int kStep>
void StepTimeRate(FlightCommands& flight) {
  SceneClock& clock = flight.controller().clock();
  clock.StepRate(kStep);
  flight.Report(fmt::format("time x{:.0f}", clock.rate()));
}
template <SkyEvent kEvent>
void JumpTo(FlightCommands& flight) {
  flight.Report(flight.controller().JumpTo(kEvent));
}

void Centre(FlightCommands& flight) {
  flight.controller().pilot().Centre(flight.controller().ground());
}

void Lift(FlightCommands& flight) {
  constexpr double kThousandFeet_m = 304.8;
  flight.controller().pilot().Lift(kThousandFeet_m, flight.controller().ground());
}

void ToggleExposureLock(FlightCommands& flight) {
  const bool locks = !flight.exposure().exposure().locked;
  flight.exposure().Lock(locks);
  flight.Report(locks ? "exposure locked" : "exposure follows the meter");
}

void ResetExposure(FlightCommands& flight) {
  flight.exposure().Reset();
  flight.Report("exposure follows the meter");
}

void UseAerosol(FlightCommands& flight, double aerosol) {
  AirChoice choice = flight.air_choice();
  choice.aerosol = aerosol;
  flight.Use(choice);
  flight.Report(
      fmt::format("visibility {:.1f} km", 1e-3 * VisibilityOf(Changed(flight.planet(), choice))));
}
template <int kStep>
void StepHaze(FlightCommands& flight) {
  constexpr double kHazeStep = 1.25;
  const double factor = kStep > 0 ? kHazeStep : 1.0 / kHazeStep;
  UseAerosol(flight, std::clamp(flight.air_choice().aerosol * factor, 1e-3, 1000.0));
}

/// Changes the cover of all layers that have a choice; a clear sky gets fair-weather clouds.
template <int kStep>
void StepCover(FlightCommands& flight) {
  constexpr double kCoverStep = 0.1;
  std::vector<SceneCloud> clouds = flight.clouds();
  if (clouds.empty() && kStep > 0) clouds = CloudsFromText("fair");
  std::string covers;
  for (SceneCloud& layer : clouds) {
    if (!layer.grid.empty()) continue;
    const auto [least, most] = CoversOf(layer.options.genus);
    layer.options.cover = std::clamp(layer.options.cover + kStep * kCoverStep, least, most);
    covers +=
        fmt::format(" {} {:.2f}", kCloudGenusNames.Of(layer.options.genus), layer.options.cover);
  }
  flight.Use(clouds);
  flight.Report(covers.empty() ? "no clouds" : "clouds:" + covers);
}

void UseNextQuality(FlightCommands& flight) {
  const std::optional<Quality> fixed = flight.quality().fixed;
  const int next = fixed ? static_cast<int>(*fixed) + 1 : 0;
  flight.Use(next > static_cast<int>(Quality::kReference)
                 ? QualityRule{}
                 : QualityRule{static_cast<Quality>(next)});
}

void TogglePause(FlightCommands& flight) {
  SceneClock& clock = flight.controller().clock();
  clock.Pause(!clock.paused());
  if (clock.paused()) flight.Report("paused");
}

void UseRealTime(FlightCommands& flight) {
  flight.controller().clock().SetRate(1.0);
  flight.Report("time x1");
}

constexpr int kMinute_s = 60, kHour_s = 3600, kDay_s = 86400;

constexpr Action kActions[] = {
    Once(kAllKeys, "free camera", "1, Ctrl+V", Enter<FlightMode::kFree>),
    Once(kAllKeys, "aircraft", "2", Enter<FlightMode::kAircraft>),
    Once(kAllKeys, "follow the track", "3", Enter<FlightMode::kTrack>),
    OnPad(GLFW_GAMEPAD_BUTTON_B, Once(kAllKeys, "next mode", "V", EnterNext<1>)),
    Once(kAllKeys, "previous mode", "Shift+V", EnterNext<-1>),
    OnPad(GLFW_GAMEPAD_BUTTON_A,
          Once(kAllKeys, "centre the stick; look ahead, level", "5, Keypad 5", Centre)),
    Once(kAllKeys, "1000 ft higher", "Ctrl+U", Lift),
    OnPad(GLFW_GAMEPAD_BUTTON_Y, Once(kWindowKeys, "hide or show everything but the picture", "H",
                                      Switch<WindowPart::kInstruments>)),
    Once(kWindowKeys, "night colours of the instruments, on and off", "Shift+H",
         Switch<WindowPart::kNightColours>),
    Once(kWindowKeys, "mouse: cursor, look, fly", "Tab", Switch<WindowPart::kMouseMode>),
    Once(kWindowKeys, "menu of the panels, on and off", "F10", Switch<WindowPart::kMenu>),
    Once(kWindowKeys, "full screen, on and off", "Shift+F10", Switch<WindowPart::kFullScreen>),
    OnPad(GLFW_GAMEPAD_BUTTON_BACK,
          Once(kWindowKeys, "show or hide the keys", "?, F1", Switch<WindowPart::kHelp>)),
    Once(kWindowKeys, "close the panels, or leave the flight", "Esc",
         Switch<WindowPart::kLeaveQuestion>),
    Moves("fly forward", "W", &Steering::forward, 1.0),
    Moves("fly back", "S", &Steering::forward, -1.0),
    Moves("fly to the left", "A", &Steering::right, -1.0),
    Moves("fly to the right", "D", &Steering::right, 1.0),
    Moves("fly up", "R, Page Up", &Steering::up, 1.0),
    Moves("fly down", "F, Page Down", &Steering::up, -1.0),
    Moves("roll to the left", "Q", &Steering::roll_right, -1.0),
    Moves("roll to the right", "E", &Steering::roll_right, 1.0),
    Moves("turn to the left", "Left, Keypad 4", &Steering::turn_right, -1.0),
    Moves("turn to the right", "Right, Keypad 6", &Steering::turn_right, 1.0),
    Moves("look up", "Up, Keypad 8", &Steering::pitch_up, 1.0),
    Moves("look down", "Down, Keypad 2", &Steering::pitch_up, -1.0),
    OnWheel(1, Again(kSpeedKeys, "faster (also the mouse wheel)", "+, Keypad +", StepSpeed<1>,
                     kNotAircraft)),
    OnWheel(-1, Again(kSpeedKeys, "slower (also the mouse wheel)", "-, Keypad -", StepSpeed<-1>,
                      kNotAircraft)),
    Again(kTrackKeys, "ten seconds ahead on the track", "Right", SkipTrack<10>, kTrack),
    Again(kTrackKeys, "ten seconds back on the track", "Left", SkipTrack<-10>, kTrack),
    Moves("stick forward: nose down", "Up, Keypad 8", &Stick::pitch_up, -1.0),
    Moves("stick back: nose up", "Down, Keypad 2", &Stick::pitch_up, 1.0),
    Moves("bank to the left", "Left, Keypad 4", &Stick::roll_right, -1.0),
    Moves("bank to the right", "Right, Keypad 6", &Stick::roll_right, 1.0),
    Moves("rudder to the left", "0, Keypad 0, Insert", &Stick::yaw_right, -1.0),
    Moves("rudder to the right", "Enter, Keypad Enter", &Stick::yaw_right, 1.0),
    Moves("more throttle", "Page Up, Keypad 9, 9", &Stick::throttle_up, 1.0),
    Moves("less throttle", "Page Down, Keypad 3", &Stick::throttle_up, -1.0),
    Moves("brakes of the wheels", "B", &Stick::brake, 1.0),
    Once(kAircraftKeys, "flight twice as fast, up to 32 times", "A", StepSpeed<1>, kAircraft),
    Once(kAircraftKeys, "flight half as fast, down to real time", "Shift+A", StepSpeed<-1>,
         kAircraft),
    Once(kAutopilotKeys, "hold the heading; banking moves it", "Ctrl+H",
         Hold<Autopilot::Hold::kHeading>, kAircraft),
    Once(kAutopilotKeys, "hold the height; the stick moves it", "Ctrl+A",
         Hold<Autopilot::Hold::kHeight>, kAircraft),
    Once(kAutopilotKeys, "hold the climb; the stick moves it", "Ctrl+P",
         Hold<Autopilot::Hold::kClimb>, kAircraft),
    Once(kAutopilotKeys, "hold the speed; the throttle moves it", "Ctrl+S",
         Hold<Autopilot::Hold::kSpeed>, kAircraft),
    Once(kAutopilotKeys, "keep the wings level", "Ctrl+W", Hold<Autopilot::Hold::kLevelWings>,
         kAircraft),
    Once(
        kAutopilotKeys, "autopilot off", "Backspace",
        [](FlightCommands& flight) { flight.Report(flight.controller().ReleaseAutopilot()); },
        kAircraft),
    Once(kExposureKeys, "lock or unlock the exposure", "L", ToggleExposureLock),
    OnPad(GLFW_GAMEPAD_BUTTON_DPAD_UP,
          Again(kExposureKeys, "a third of a stop brighter", "K", Compensate<1>)),
    OnPad(GLFW_GAMEPAD_BUTTON_DPAD_DOWN,
          Again(kExposureKeys, "a third of a stop darker", "Shift+K", Compensate<-1>)),
    Once(kExposureKeys, "metered exposure", "Ctrl+K", ResetExposure),
    OnWheel(1, OnPad(GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER,
                     Again(kViewKeys, "narrower view (aircraft: also the wheel)", "X", Zoom<-1>),
                     kNotAircraft)),
    OnWheel(-1, OnPad(GLFW_GAMEPAD_BUTTON_LEFT_BUMPER,
                      Again(kViewKeys, "wider view (aircraft: also the wheel)", "Shift+X", Zoom<1>),
                      kNotAircraft)),
    OnPad(GLFW_GAMEPAD_BUTTON_RIGHT_THUMB,
          Once(kViewKeys, "field of view of the scene", "Ctrl+X",
               [](FlightCommands& flight) { flight.controller().pilot().ResetView(); })),
    Again(kViewKeys, "farther visibility", "Z", StepHaze<-1>),
    Again(kViewKeys, "shorter visibility", "Shift+Z", StepHaze<1>),
    Once(kViewKeys, "visibility of the scene", "Ctrl+Z",
         [](FlightCommands& flight) { UseAerosol(flight, 1.0); }),
    Again(kViewKeys, "more clouds", "C", StepCover<1>),
    Again(kViewKeys, "fewer clouds", "Shift+C", StepCover<-1>),
    Once(kViewKeys, "landing light, on and off", "Ctrl+L",
         [](FlightCommands& flight) { flight.ToggleLandingLight(); }),
    Once(kViewKeys, "next quality", "O", UseNextQuality),
    OnPad(GLFW_GAMEPAD_BUTTON_START,
          Once(kTimeKeys, "pause time, aircraft and track", "P", TogglePause)),
    Again(kTimeKeys, "rate of time up: -3600 to 3600", "T", StepTimeRate<1>),
    Again(kTimeKeys, "rate of time down, and backwards", "Shift+T", StepTimeRate<-1>),
    Once(kTimeKeys, "real time", "Shift+P", UseRealTime),
    OnPad(GLFW_GAMEPAD_BUTTON_DPAD_RIGHT,
          OutsideFreeCamera("W", Again(kTimeKeys, "a minute later", "]", Shift<kMinute_s>))),
    OnPad(
        GLFW_GAMEPAD_BUTTON_DPAD_LEFT,
        OutsideFreeCamera("Shift+W", Again(kTimeKeys, "a minute earlier", "[", Shift<-kMinute_s>))),
    Again(kTimeKeys, "an hour later", "Shift+]", Shift<kHour_s>),
    Again(kTimeKeys, "an hour earlier", "Shift+[", Shift<-kHour_s>),
    Again(kTimeKeys, "a day later", "Ctrl+]", Shift<kDay_s>),
    Again(kTimeKeys, "a day earlier", "Ctrl+[", Shift<-kDay_s>),
    Once(kTimeKeys, "next dawn", "Shift+F5", JumpTo<SkyEvent::kDawn>),
    Once(kTimeKeys, "next sunrise", "F5", JumpTo<SkyEvent::kSunrise>),
    Once(kTimeKeys, "next noon", "F6", JumpTo<SkyEvent::kNoon>),
    Once(kTimeKeys, "next sunset", "F7", JumpTo<SkyEvent::kSunset>),
    Once(kTimeKeys, "next dusk", "F8", JumpTo<SkyEvent::kDusk>),
    Once(kTimeKeys, "next moonrise", "F9", JumpTo<SkyEvent::kMoonrise>),
    Once(kTimeKeys, "next moonset", "Shift+F9", JumpTo<SkyEvent::kMoonset>),
    OnPad(GLFW_GAMEPAD_BUTTON_X, NeedsPicture(Once(kCaptureKeys, "screenshot, PNG", "F3",
                                                   [](FlightCommands& flight) {
                                                     flight.Request({.extension = ".png"});
                                                   }))),
    NeedsPicture(Once(kCaptureKeys, "screenshot, linear EXR", "Shift+F3",
                      [](FlightCommands& flight) { flight.Request({.extension = ".exr"}); })),
    Once(kCaptureKeys, "write the flight so far to a file", "Shift+F2",
         [](FlightCommands& flight) { flight.Use(FlightSoFar::kSave); }),
    Once(kCaptureKeys, "fly this flight again", "Ctrl+R",
         [](FlightCommands& flight) { flight.Use(FlightSoFar::kShowAgain); }),
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
  const Action* action;
  Modes modes;
};

std::vector<Binding> AllBindings() {
  std::vector<Binding> bindings;
  for (const Action& action : kActions) {
    for (const std::string_view key : SplitAtCommas(action.keys))
      bindings.push_back({KeyChordFromText(key), &action, action.modes});
    for (const std::string_view key : SplitAtCommas(action.keys_outside_free_camera))
      bindings.push_back({KeyChordFromText(key), &action, kNotFree});
  }
  return bindings;
}

bool Fits(const Binding& binding, int key, int modifiers, FlightMode mode) {
  if (binding.chord.key != key || !binding.modes.Has(mode)) return false;
  const bool any_shift = binding.chord.any_shift || binding.action->press == Press::kHeld;
  const int counted = any_shift ? modifiers & ~kShiftKey : modifiers;
  return counted == binding.chord.modifiers;
}

}  // namespace

bool Modes::Has(FlightMode mode) const {
  return mode == FlightMode::kFree ? free : mode == FlightMode::kAircraft ? aircraft : track;
}

std::span<const Action> ActionTable() { return kActions; }

std::vector<ActionSection> ActionSections() {
  std::vector<ActionSection> sections;
  for (const Action& action : kActions) {
    if (sections.empty() || sections.back().heading != action.heading)
      sections.push_back({action.heading, {&action, 0}});
    std::span<const Action>& rows = sections.back().rows;
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

const Action* ActionOfKey(int key, int modifiers, FlightMode mode) {
  static const std::vector<Binding> bindings = AllBindings();
  // Caps Lock and Num Lock are modifiers too; ignore them.
  const int counted = modifiers & (kShiftKey | kControlKey | kAltKey);
  for (const Binding& binding : bindings) {
    if (Fits(binding, key, counted, mode)) return binding.action;
  }
  return nullptr;
}

const Action& ActionOfWheel(int step, FlightMode mode) {
  const auto* found = std::find_if(
      std::begin(kActions), std::end(kActions),
      [&](const Action& action) { return action.wheel == step && action.modes.Has(mode); });
  ALPENGLOW_ENSURE(found == std::end(kActions), ==, false);
  return *found;
}

int PrintedKey(int key, const char* name) {
  if (name == nullptr || name[0] == '\0' || name[1] != '\0') return key;
  const char c =
      name[0] >= 'a' && name[0] <= 'z' ? static_cast<char>(name[0] - 'a' + 'A') : name[0];
  const bool keypad = key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_EQUAL;
  return !keypad && IsLetterOrDigit(c) ? c : key;
}

std::string KeysText(const Action& action) {
  if (action.keys_outside_free_camera.empty()) return std::string(action.keys);
  return fmt::format("{}; {} (aircraft, track)", action.keys, action.keys_outside_free_camera);
}

std::string ControlsMarkdown() {
  std::string text = "| | keys | what they do |\n|---|---|---|\n";
  for (const ActionSection& section : ActionSections()) {
    for (const Action& action : section.rows) {
      const bool is_first = &action == section.rows.data();
      text += fmt::format("| {} | {} | {} |\n", is_first ? section.heading : "", KeysText(action),
                          action.help);
    }
  }
  return text;
}

std::string FirstKeysText() {
  std::string text;
  for (const char* key :
       {"?", "W", "S",       "A",  "D",  "R", "F",       "Left", "Right", "Up", "Down", "1",
        "2", "T", "Shift+T", "F5", "F7", "X", "Shift+X", "F3",   "F10",   "H",  "Esc"}) {
    const KeyChord chord = KeyChordFromText(key);
    const Action* action = ActionOfKey(chord.key, chord.modifiers, FlightMode::kFree);
    ALPENGLOW_ENSURE(action == nullptr, ==, false);
    text += fmt::format("{}{}: {}", text.empty() ? "" : "\n      ", key, action->help);
  }
  return text;
}

}  // namespace alpenglow::viewer
