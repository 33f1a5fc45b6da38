// SPDX-License-Identifier: MIT
// Provides the clock of the scene, which runs at a rate, pauses, and jumps to events of the sun and
// the moon; and FlightController, which holds pilot and clock, and does what affects both of them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/scene/places.h"
#include "viewer/flight/pilot.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Returns the rate that is one step faster (+1) or slower (-1) than `rate`, in scene seconds per
/// real second: ..., -60, -10, -1, 0, 1, 10, 60, ... up to 3600 in both directions.
[[nodiscard]] double SteppedTimeRate(double rate, int step);

/// Events of the sun and the moon. Dawn and dusk are the civil ones (the sun is 6 degrees below the
/// horizon).
enum class SkyEvent { kDawn, kSunrise, kNoon, kSunset, kDusk, kMoonrise, kMoonset };
inline constexpr std::array<SkyEvent, 7> kSkyEvents{
    SkyEvent::kDawn, SkyEvent::kSunrise,  SkyEvent::kNoon,   SkyEvent::kSunset,
    SkyEvent::kDusk, SkyEvent::kMoonrise, SkyEvent::kMoonset};
/// Returns "dawn", "sunrise", ...
[[nodiscard]] const char* NameOf(SkyEvent event);

/// Returns the next occurrence of an event at a place, after an instant and for the sun more than a
/// second after it. Instants are those of FindSunEvent and NextMoonEvent. Returns nullopt if the
/// event does not occur within 366 days (sun) or 30 days (moon).
[[nodiscard]] std::optional<UtcTime> NextEvent(SkyEvent event, const Place& place,
                                               const UtcTime& after);

/// Clock of the scene. Its range is the years 1900 to 2100; it stops at their ends.
class SceneClock {
 public:
  explicit SceneClock(const UtcTime& start) : now_(start) {}

  [[nodiscard]] const UtcTime& now() const { return now_; }
  /// Rate in seconds per second; it is kept while the clock is paused.
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Advances the clock by a number of real seconds.
  void Advance(double seconds);
  void Pause(bool paused) { paused_ = paused; }
  void StepRate(int step) { rate_ = SteppedTimeRate(rate_, step); }
  /// Throws InputError if the rate is not in [-3600, 3600].
  void SetRate(double rate);

  /// Shifts the time, whether the clock is paused or not.
  void Shift(double seconds);
  void Set(const UtcTime& instant);
  /// Jumps to the next occurrence of the event. Returns false and changes nothing if NextEvent
  /// finds none.
  bool JumpToNext(SkyEvent event, const Place& place);
  /// Sets the time from a text, as InstantFromText (time_text.h). The day is that
  /// of this clock in the zone, but "today" and "now" refer to the clock of the computer. Throws
  /// InputError.
  void Type(const std::string& text, const Place& place, const std::string& zone);

 private:
  UtcTime now_;
  double rate_ = 1.0;
  bool paused_ = false;
};

class FlightController {
 public:
  FlightController(const CameraPose& eye, const Ellipsoid& ellipsoid, const UtcTime& start,
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
  void AdvanceClock(const std::optional<UtcTime>& before, double seconds);
  void EndReplay();

  GroundHeight ground_;
  Pilot pilot_;
  SceneClock clock_;
  std::optional<Pilot> waits_;  // resumes at the end of FlyAgain
};

}  // namespace alpenglow::viewer
