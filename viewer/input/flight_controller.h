// SPDX-License-Identifier: MIT
// Pilot and clock, and the actions that affect them. Actions that affect the picture or the program
// are handled elsewhere.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "renderer/scene/places.h"
#include "viewer/flight/clock.h"
#include "viewer/flight/pilot.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

class FlightController {
 public:
  FlightController(const Eye& eye, const Ellipsoid& ellipsoid, const UtcInstant& start)
      : pilot_(eye, ellipsoid), clock_(start) {}

  [[nodiscard]] Pilot& pilot() { return pilot_; }
  [[nodiscard]] const Pilot& pilot() const { return pilot_; }
  [[nodiscard]] SceneClock& clock() { return clock_; }
  [[nodiscard]] const SceneClock& clock() const { return clock_; }

  /// Executes an action. Returns the result as text for the screen (empty: no message); no value if
  /// the action concerns neither flight nor time.
  [[nodiscard]] std::optional<std::string> Do(Action action, const GroundHeight& ground);

  /// Changes the mode. Returns its name, or the reason why it cannot be entered.
  [[nodiscard]] std::string Enter(FlightMode mode, const GroundHeight& ground);

  /// Moves the clock to the next occurrence of an event; returns its name, or a message if there is
  /// none within a year.
  [[nodiscard]] std::string JumpTo(SkyEvent event);

  /// Flies to a place of the list: with the aircraft onto the runway, otherwise above it.
  void GoTo(const NamedPlace& there, const GroundHeight& ground) {
    pilot_.PutAt(EyeAt(there, pilot_.eye(), ground), ground);
  }

  /// Replays a recorded flight, with its field of view and, if it has instants, its time. The free
  /// camera takes over at its end.
  void Replay(std::shared_ptr<const CameraPath> flight, const GroundHeight& ground);
  /// Replays the flight of this pilot so far; at its end the pilot continues the present flight. A
  /// pilot who takes over earlier continues from that point.
  void FlyAgain(std::shared_ptr<const CameraPath> flown, const GroundHeight& ground);

  /// Advances by any number of real seconds. While paused, aircraft, track and clock stand still;
  /// the free camera still moves, and the view can turn. A flight at 4 times its speed also speeds
  /// up the clock.
  void Advance(const PilotControls& controls, double seconds, const GroundHeight& ground);

 private:
  [[nodiscard]] std::optional<std::string> DoFlight(Action action, const GroundHeight& ground);
  [[nodiscard]] std::optional<std::string> DoAutopilot(Action action);
  [[nodiscard]] std::optional<std::string> DoTime(Action action);
  void SkipTrack(double seconds);
  void AdvanceClock(const std::optional<UtcInstant>& before, double seconds);
  void EndReplay(const GroundHeight& ground);

  Pilot pilot_;
  SceneClock clock_;
  std::optional<Pilot> waits_;  // resumes at the end of FlyAgain
};

}  // namespace alpenglow::viewer
