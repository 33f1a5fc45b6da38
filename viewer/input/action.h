// SPDX-License-Identifier: MIT
// Actions of the user: one table with the key, the gamepad button, the help text and the effect of
// each, for the keyboard, the gamepad, the help on the screen and the manual. FlightCommands is
// what actions and panels can change.
//
// Keys follow FlightGear where it defines them (its keyboard.xml); in the free camera W A S D, R F
// and Q E move the eye, as in other viewers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/medium/medium_presets.h"
#include "lut/image/picture_format.h"
#include "viewer/flight/flight.h"
#include "viewer/flight/flight_controller.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/exposure_control.h"

namespace alpenglow::viewer {

/// Parts of the window that are switched on and off.
enum class WindowPart {
  kInstruments,    // and panels
  kNightColours,   // of the instruments
  kMenu,           // of the panels
  kFullScreen,     // or a window
  kHelp,           // the panel with the keys
  kLeaveQuestion,  // closes all panels first
  kMouseMode       // the next one of cursor, look and fly
};

/// A picture that is written to a file of the current folder.
struct PictureOrder {
  std::string extension = PictureFormats().front().extension;
  std::optional<ImageSize> size = {};  // nullopt: that of the window
  bool with_instruments = false;
};

/// Uses of the flight since its beginning: it is written to a file, or shown from its beginning and then
/// continued.
enum class FlightSoFar { kSave, kShowAgain };

/// Changes that keys, gamepad and panels can make. Failures are reported to the user, not thrown.
class FlightCommands {
 public:
  virtual ~FlightCommands() = default;

  [[nodiscard]] virtual FlightController& controller() = 0;
  [[nodiscard]] virtual ExposureControl& exposure() = 0;
  [[nodiscard]] virtual const QualityRule& quality() const = 0;
  virtual void Use(const QualityRule& rule) = 0;

  /// Returns the medium of the planet without the changes of air_choice().
  [[nodiscard]] virtual const Medium& planet() const = 0;
  virtual void UsePlanet(const std::string& preset) = 0;
  [[nodiscard]] virtual const AirChoice& air_choice() const = 0;
  virtual void Use(const AirChoice& choice) = 0;
  [[nodiscard]] virtual const std::vector<SceneCloud>& clouds() const = 0;
  virtual void Use(const std::vector<SceneCloud>& clouds) = 0;
  virtual void ToggleLandingLight() = 0;

  virtual void MoveTo(const EyePlacement& placement) = 0;
  /// Goes to a place of the list (places.h).
  virtual void GoTo(const std::string& place) = 0;
  /// Sets the time from a text (SceneClock::Type).
  virtual void SetTime(const std::string& text) = 0;

  virtual void Request(const PictureOrder& picture) = 0;
  /// Starts or ends the record of the flight.
  virtual void Record(bool records) = 0;
  virtual void Use(FlightSoFar use) = 0;
  virtual void Switch(WindowPart part) = 0;
  /// Ends the flight as soon as all requested pictures are written; a second call drops them.
  virtual void Leave() = 0;
  /// Displays a message. An empty one is ignored.
  virtual void Report(const std::string& message) = 0;
};

/// Flight modes in which a key has an effect.
struct Modes {
  bool free = true, aircraft = true, track = true;
  [[nodiscard]] bool Has(FlightMode mode) const;
};

/// Trigger of a key: once when it goes down; also on keyboard repeats; as long as it is held.
enum class Press { kOnce, kRepeating, kHeld };

/// Control that a held key moves, one of the camera or one of the stick, and its direction.
struct HeldControl {
  double Steering::*camera = nullptr;
  double Stick::*stick = nullptr;
  double sign = 1.0;

  /// Returns whether both keys move the same control.
  [[nodiscard]] bool IsOf(const HeldControl& other) const {
    return camera == other.camera && stick == other.stick;
  }
};

/// Button of a gamepad with GLFW's number, and the modes in which it acts.
struct PadButton {
  int button = -1;  // -1: none
  Modes modes = {};
};

/// One line of the table.
struct Action {
  std::string_view heading, help;
  std::string_view keys;  // "Page Up, Keypad 9"
  Press press = Press::kOnce;
  Modes modes = {};
  void (*run)(FlightCommands& flight) = nullptr;  // null for a held key
  HeldControl moves = {};                         // of a held key
  // Additional keys in aircraft and track modes.
  std::string_view keys_outside_free_camera = "";
  PadButton pad = {};
  int wheel = 0;               // 1, -1: a step of the mouse wheel forward or back also acts
  bool needs_picture = false;  // refused while the window is minimised
};

/// Returns all lines. Those with the same heading follow one another. Modes and window come first,
/// then the flight in each mode, then exposure, view, time and capture.
[[nodiscard]] std::span<const Action> ActionTable();

/// The lines under one heading.
struct ActionSection {
  std::string_view heading;
  std::span<const Action> rows;
};
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

/// Returns the action of a key in a mode; null for most keys. Held keys also act with Shift, but
/// not with Ctrl or Alt.
[[nodiscard]] const Action* ActionOfKey(int key, int modifiers, FlightMode mode);
/// Returns the action of a step of the mouse wheel: 1 forward, -1 back.
[[nodiscard]] const Action& ActionOfWheel(int step, FlightMode mode);

/// Returns the number of the key with the label `name` on the keyboard (glfwGetKeyName): letters
/// have other positions on a French keyboard. Returns `key` if the name is neither a letter nor a
/// digit.
[[nodiscard]] int PrintedKey(int key, const char* name);

/// Returns "T, Keypad 9": all keys of a line.
[[nodiscard]] std::string KeysText(const Action& action);

/// Returns the table for the manual.
[[nodiscard]] std::string ControlsMarkdown();
/// Returns the keys that a newcomer needs, one a line after "Keys: ", for --help.
[[nodiscard]] std::string FirstKeysText();

}  // namespace alpenglow::viewer
