// SPDX-License-Identifier: MIT
// What hands say to whatever flies, in one frame.
//
// An autopilot: it moves what the aircraft's own computer holds (aircraft.h), and the throttle.
//
//   heading          tan(bank) = v (target - heading) / (4 s g), to 25 degrees, at 8 degrees/s
//   height           climb = (target - height) / 6 s, to 6 degrees of path
//   vertical speed   sin(path) = climb / v, at 2 degrees/s
//   speed            throttle' = 0.07 (target - v) - 0.5 v', [1/s] for m/s
//
// It begins from where the aircraft is, so that engaging it jerks nothing. From level flight a new
// heading is reached with an overshoot of less than 2 degrees, a new height of less than 5 m, a new
// speed of less than 1 m/s.
//
// Who flies: the free camera, the aircraft or a track, one at a time; and where the eye is then.
//
// Real seconds come in, however many: aircraft fly them in steps of 1/120 s, and what is seen is
// the state at the end of the last one carried on by the rest, so that neither flights nor their
// smoothness depend on the frame rate.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "renderer/camera/camera_path.h"
#include "viewer/flight/aircraft.h"
#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

struct PilotControls {
  Steering camera = {};  // the free camera
  Stick stick = {};      // the aircraft
  /// Looking around with the mouse or the right stick, in this frame: in widths of the view.
  double look_right = 0.0, look_up = 0.0;
};

/// What is held; at most one of a heading and level wings, and of a height and a climb.
struct AutopilotTargets {
  std::optional<double> heading_rad = {}, height_m = {}, climb_m_per_s = {}, speed_m_per_s = {};
  bool level_wings = false;

  [[nodiscard]] bool HoldsAnything() const;
};

/// "HDG 270 ALT 1500 m SPD 60 m/s"; empty when nothing is held.
[[nodiscard]] std::string TextOf(const AutopilotTargets& targets);

class Autopilot {
 public:
  enum class Hold { kHeading, kHeight, kClimb, kSpeed, kLevelWings };

  [[nodiscard]] const AutopilotTargets& targets() const { return targets_; }
  void Set(const AutopilotTargets& targets) { targets_ = targets; }
  /// Begins to hold what the aircraft does now, or lets go of it.
  void Toggle(Hold hold, const AircraftReadout& now, double height_m);
  void Release() { targets_ = {}; }

  /// The aircraft with what its computer is to hold, and what is left of the hands' wishes: a stick
  /// that is moved against something held moves the target.
  struct Flown {
    AircraftState state;
    Stick stick;
  };
  [[nodiscard]] Flown Fly(const AircraftState& state, const AircraftKind& kind,
                          const Ellipsoid& ellipsoid, const Stick& hands, double step_s);

 private:
  void MoveTargets(const Stick& hands, double step_s);
  void FlyPath(const AircraftReadout& now, double from_m, double step_s, Flown& flown) const;
  [[nodiscard]] double ThrottleUp(const AircraftReadout& now, double step_s) const;

  AutopilotTargets targets_;
  std::optional<double> speed_before_m_per_s_;
};

/// Where something flies to: heading clockwise from north, climb over the horizontal.
struct Course {
  double heading_rad, climb_rad;
};

/// For instruments, in every mode.
struct FlightReadout {
  FlightMode mode = FlightMode::kFree;
  double speed_m_per_s = 0.0;           // over the ground, of the last frame
  double vertical_speed_m_per_s = 0.0;  // up is positive
  double above_ground_m = 0.0;
  std::optional<Course> course;  // none while it stands
  double speed_factor = 1.0;  // of the free camera; of the track's time; of the flight's (1 to 32)
  std::optional<AircraftReadout> aircraft;  // in aircraft mode
  std::string_view aircraft_name;           // "" elsewhere
  std::string autopilot;                    // as TextOf(AutopilotTargets)
};

class Pilot {
 public:
  /// A free camera.
  Pilot(const Eye& eye, const Ellipsoid& ellipsoid);

  [[nodiscard]] FlightMode mode() const { return mode_; }
  [[nodiscard]] const Eye& eye() const { return eye_; }

  /// Changes the mode where the eye is; a track begins at its beginning, or where it was left. In
  /// less than 15 m over the ground the aircraft stands on it. Returns why not, in words, or
  /// nothing.
  [[nodiscard]] std::optional<std::string> Enter(FlightMode mode, const GroundHeight& ground);
  /// Puts the eye somewhere else, in the mode that it is in; leaves a track for the free camera.
  void PutAt(const Eye& eye, const GroundHeight& ground);
  /// Lifts the eye out of ground that has become known.
  void KeepAbove(const GroundHeight& ground) { Show(ground); }
  /// What kTrack follows, from its beginning, as fast as it is. Gives it up when there is none.
  /// @param lens  whose field of view is seen: the eye's own, or that of the track (a replay)
  enum class Lens { kOfEye, kOfTrack };
  void SetTrack(std::shared_ptr<const CameraPath> track, Lens lens = Lens::kOfEye);
  [[nodiscard]] bool HasTrack() const { return track_ != nullptr; }
  /// Whether a track is followed through its own lens.
  [[nodiscard]] bool Replays() const {
    return mode_ == FlightMode::kTrack && track_lens_ == Lens::kOfTrack;
  }
  [[nodiscard]] bool IsAtEndOfTrack() const { return !track_ || track_s_ >= track_->end_s(); }

  /// Lets real seconds pass. Where the ground has come up over the aircraft by more than 30 m (its
  /// terrain was loaded), it flies on 150 m over it.
  void Advance(const PilotControls& controls, double seconds, const GroundHeight& ground);

  /// Faster (+1) or slower (-1), by half: the free camera 1/64 to 64, the track 1/8 to 64; the
  /// aircraft by the double, 1 to 32. A time of 32 flies 32 s in a second.
  void StepSpeed(int step);
  /// How much faster than real time aircraft and track are flown; the scene's clock goes with it.
  [[nodiscard]] double time_factor() const;
  /// Moves along the track, to its ends at most.
  void SkipTrack(double seconds);
  /// What the track says the time is; nothing elsewhere.
  [[nodiscard]] std::optional<UtcInstant> TrackUtc() const;

  void Zoom(double factor) { eye_ = Zoomed(eye_, factor); }
  void ResetView() { eye_.fov_rad = first_fov_rad_; }
  /// Looks ahead, wings level; lets go of nothing else.
  void Centre(const GroundHeight& ground);
  /// Up by so much; in the aircraft with enough speed to fly on. A track stays where it is.
  void Lift(double height_m, const GroundHeight& ground);

  /// Opens the throttle to a share, clamped to [0, 1], and lets go of the speed; in aircraft mode.
  void SetThrottle(double share);
  /// In aircraft mode; elsewhere nothing is held.
  void ToggleHold(Autopilot::Hold hold);
  void ReleaseAutopilot() { autopilot_.Release(); }
  [[nodiscard]] Autopilot& autopilot() { return autopilot_; }
  [[nodiscard]] const Autopilot& autopilot() const { return autopilot_; }

  [[nodiscard]] FlightReadout Readout(const GroundHeight& ground) const;

 private:
  void BeginFlight(double heading_rad, const GroundHeight& ground);
  void FlyAircraft(const Stick& stick, double seconds, const GroundHeight& ground);
  [[nodiscard]] AircraftState NextState(Autopilot& autopilot, const Stick& stick, double step_s,
                                        const GroundHeight& ground) const;
  void LeaveTheGround(const GroundHeight& ground);
  void NoteSpeed(const GeodeticPosition& before, double seconds);
  void LookAround(const PilotControls& controls);
  void Show(const GroundHeight& ground);

  Ellipsoid ellipsoid_;
  FlightMode mode_ = FlightMode::kFree;
  Eye eye_;
  double first_fov_rad_;
  double free_factor_ = 1.0, track_factor_ = 1.0, flight_factor_ = 1.0;
  double look_right_rad_ = 0.0, look_up_rad_ = 0.0;
  double speed_m_per_s_ = 0.0, vertical_speed_m_per_s_ = 0.0;
  std::optional<Course> course_;

  AircraftKind kind_ = kLightAircraft;
  AircraftState aircraft_, shown_;
  Autopilot autopilot_;
  double rest_s_ = 0.0;  // not flown yet, less than a step

  std::shared_ptr<const CameraPath> track_;
  Lens track_lens_ = Lens::kOfEye;
  double track_s_ = 0.0;
};

}  // namespace alpenglow::viewer
