// SPDX-License-Identifier: MIT
// Pilot and clock, and what affects both of them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "renderer/scene/places.h"
#include "viewer/flight/clock.h"
#include "viewer/flight/pilot.h"

namespace alpenglow::viewer {

class FlightController {
 public:
  FlightController(const CameraPose& eye, const Ellipsoid& ellipsoid, const UtcInstant& start,
                   GroundHeight ground)
      : ground_(std::move(ground)), pilot_(eye, ellipsoid), clock_(start) {}

  [[nodiscard]] Pilot& pilot() { return pilot_; }
  [[nodiscard]] const Pilot& pilot() const { return pilot_; }
  [[nodiscard]] SceneClock& clock() { return clock_; }
  [[nodiscard]] const SceneClock& clock() const { return clock_; }
  [[nodiscard]] const GroundHeight& ground() const { return ground_; }

  /// Changes the mode. Returns its name, or the reason why it cannot be entered.
  std::string Enter(FlightMode mode);
  /// Enters the next (1) or previous (-1) mode; the track is skipped if there is none.
  std::string EnterNext(int step);
  /// See Pilot. Returns "speed x1.5".
  std::string StepSpeed(int step);
  /// Moves along the track, and the clock with it if the track has times.
  void SkipTrack(double seconds);
  /// Starts or stops holding a value. Returns what is held; empty outside of the aircraft.
  std::string ToggleHold(Autopilot::Hold hold);
  std::string ReleaseAutopilot();
  /// Moves the clock to the next occurrence of an event; returns its name, or a message if there is
  /// none within a year.
  std::string JumpTo(SkyEvent event);

  /// Flies to a place of the list: with the aircraft onto the runway, otherwise above it.
  void GoTo(const NamedPlace& there) { pilot_.PutAt(EyeAt(there, pilot_.eye(), ground_), ground_); }

  /// Replays a recorded flight, with its field of view and, if it has instants, its time. The free
  /// camera takes over at its end.
  void Replay(std::shared_ptr<const CameraPath> flight);
  /// Replays the flight of this pilot so far; at its end the pilot continues the present flight. A
  /// pilot who takes over earlier continues from that point.
  void FlyAgain(std::shared_ptr<const CameraPath> flown);

  /// Advances by any number of real seconds. While paused, aircraft, track and clock stand still;
  /// the free camera still moves, and the view can turn. A flight at 4 times its speed also speeds
  /// up the clock.
  void Advance(const PilotControls& controls, double seconds);

 private:
  void AdvanceClock(const std::optional<UtcInstant>& before, double seconds);
  void EndReplay();

  GroundHeight ground_;
  Pilot pilot_;
  SceneClock clock_;
  std::optional<Pilot> waits_;  // resumes at the end of FlyAgain
};

}  // namespace alpenglow::viewer
