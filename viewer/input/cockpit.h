// SPDX-License-Identifier: MIT
// Pilot and clock, and what actions do to them. What an action does to the picture or the program
// is not done here.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "viewer/flight/clock.h"
#include "viewer/flight/pilot.h"
#include "viewer/flight/places.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

class Cockpit {
 public:
  Cockpit(const Eye& eye, const Ellipsoid& ellipsoid, const UtcInstant& start)
      : pilot_(eye, ellipsoid), clock_(start) {}

  [[nodiscard]] Pilot& pilot() { return pilot_; }
  [[nodiscard]] const Pilot& pilot() const { return pilot_; }
  [[nodiscard]] SceneClock& clock() { return clock_; }
  [[nodiscard]] const SceneClock& clock() const { return clock_; }

  /// What it came to, in words for the screen (empty: nothing needs saying); nothing when the action
  /// is none of flight and time.
  [[nodiscard]] std::optional<std::string> Do(Action action, const GroundHeight& ground,
                                              const MoonEventAfter& moon = {});

  /// Moves the clock on to what the sky does next; says to what.
  [[nodiscard]] std::string JumpTo(SkyEvent event, const MoonEventAfter& moon);

  /// Flies to a place of the list: on the runway with the aircraft, over it otherwise.
  void GoTo(const NamedPlace& there, const GroundHeight& ground) {
    pilot_.PutAt(EyeAt(there, pilot_.eye(), ground), ground);
  }

  /// Shows a flight as it was flown, with its field of view and, where it has instants, its time.
  /// The free camera takes over where it ends.
  void Replay(std::shared_ptr<const CameraPath> flight, const GroundHeight& ground);
  /// The same of what this pilot has flown so far: whoever flies now goes on where it ends. Who
  /// takes over before flies on from there.
  void FlyAgain(std::shared_ptr<const CameraPath> flown, const GroundHeight& ground);

  /// Lets real seconds pass, however many. Paused, aircraft, track and clock stand; the free camera
  /// still flies, and one can look around. A flight at 4 times its speed takes the clock along.
  void Advance(const PilotControls& controls, double seconds, const GroundHeight& ground);

 private:
  [[nodiscard]] std::optional<std::string> DoFlight(Action action, const GroundHeight& ground);
  [[nodiscard]] std::optional<std::string> DoAutopilot(Action action);
  [[nodiscard]] std::optional<std::string> DoTime(Action action, const MoonEventAfter& moon);
  [[nodiscard]] std::string Enter(FlightMode mode, const GroundHeight& ground);
  void SkipTrack(double seconds);
  void AdvanceClock(const std::optional<UtcInstant>& before, double seconds);
  void EndReplay(const GroundHeight& ground);

  Pilot pilot_;
  SceneClock clock_;
  std::optional<Pilot> waits_;  // to go on when FlyAgain has come to its end
};

}  // namespace alpenglow::viewer
