// SPDX-License-Identifier: MIT
// Provides Pilot, which moves the eye as a free camera, in an aircraft or along a track, the
// controls of one frame, and an autopilot for the aircraft.
//
// The autopilot changes the path and bank that the aircraft's computer holds (aircraft.h), and the
// throttle.
//
//   heading          tan(bank) = v (target - heading) / (4 s g), to 25 degrees, at 8 degrees/s
//   height           climb = (target - height) / 6 s, to 6 degrees of path
//   vertical speed   sin(path) = climb / v, at 2 degrees/s
//   speed            throttle' = 0.07 (target - v) - 0.5 v', [1/s] for m/s
//
// It starts from the current state, so that it engages smoothly. From level flight it overshoots a
// new heading by less than 2 degrees, a new height by less than 5 m, and a new speed by less than
// 1 m/s.
//
// Pilot accepts any number of real seconds. An aircraft flies in steps of 1/120 s. The displayed
// state is that of the last step, continued by the remaining time, so that neither the flight nor
// its smoothness depends on the frame rate.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "renderer/camera/camera_path.h"
#include "viewer/flight/aircraft.h"
#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

struct PilotControls {
  Steering camera = {};  // for the free camera
  Stick stick = {};      // for the aircraft
  /// Rotation of the view in this frame by the mouse or the right stick, in widths of the view.
  double look_right = 0.0, look_up = 0.0;
};

/// Targets of the autopilot. At most one of heading and level wings is held, and at most one
/// of height and climb.
struct AutopilotTargets {
  std::optional<double> heading_rad = {}, height_m = {}, climb_m_per_s = {}, speed_m_per_s = {};
  bool level_wings = false;

  [[nodiscard]] bool HoldsAnything() const;
};

/// Returns "HDG 270 ALT 1500 m SPD 60 m/s"; empty if nothing is held.
[[nodiscard]] std::string TextOf(const AutopilotTargets& targets);

class Autopilot {
 public:
  enum class Hold { kHeading, kHeight, kClimb, kSpeed, kLevelWings };

  [[nodiscard]] const AutopilotTargets& targets() const { return targets_; }
  void Set(const AutopilotTargets& targets) { targets_ = targets; }
  /// Starts to hold the current value of the aircraft, or stops holding it.
  void Toggle(Hold hold, const AircraftReadout& now, double height_m);
  void Release() { targets_ = {}; }

  /// The state with the values that its computer should hold, and the remaining stick input: stick
  /// input for a held quantity moves the target instead.
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

/// An aircraft in flight with its autopilot.
class PilotedAircraft {
 public:
  explicit PilotedAircraft(const Ellipsoid& ellipsoid) : ellipsoid_(ellipsoid) {}

  /// Starts a level flight at a place; less than 15 m above the ground, the aircraft stands on it.
  void Begin(Place place, double heading_rad, const GroundHeight& ground);
  /// Flies for a number of seconds. If the ground is more than 30 m above the aircraft because its
  /// terrain was loaded, the flight continues 150 m above the ground.
  void Fly(const Stick& stick, double seconds, const GroundHeight& ground);
  /// Raises the aircraft. If it is too slow, it gets enough speed to fly.
  void Lift(double height_m);
  /// Levels wings and path; the autopilot keeps its targets.
  void Level();

  /// Sets the throttle, clamped to [0, 1], and stops holding the speed.
  void SetThrottle(double share);
  /// Starts or stops holding a value.
  void Toggle(Autopilot::Hold hold);
  [[nodiscard]] Autopilot& autopilot() { return autopilot_; }
  [[nodiscard]] const Autopilot& autopilot() const { return autopilot_; }

  [[nodiscard]] AircraftReadout Readout() const { return ReadoutOf(shown_, kind_, ellipsoid_); }
  [[nodiscard]] std::string_view name() const { return kind_.name; }
  /// Returns the eye of the pilot, turned to the right and upwards.
  [[nodiscard]] CameraPose EyeOfPilot(double right_rad, double up_rad, double fov_rad) const {
    return EyeIn(shown_, kind_, ellipsoid_, right_rad, up_rad, fov_rad);
  }

 private:
  [[nodiscard]] AircraftState NextState(Autopilot& autopilot, const Stick& stick, double step_s,
                                        const GroundHeight& ground) const;
  void LeaveTheGround(const GroundHeight& ground);

  Ellipsoid ellipsoid_;
  AircraftKind kind_ = kLightAircraft;
  AircraftState state_, shown_;
  Autopilot autopilot_;
  double rest_s_ = 0.0;  // time not yet flown, less than a step
};

/// A camera path, and the position along it. There may be no path.
class FollowedTrack {
 public:
  FollowedTrack() = default;
  /// Starts at the beginning of a path; null: there is none.
  explicit FollowedTrack(std::shared_ptr<const CameraPath> path);

  [[nodiscard]] bool exists() const { return path_ != nullptr; }
  [[nodiscard]] bool IsAtEnd() const { return !path_ || at_s_ >= path_->end_s(); }
  /// Moves along the path, at most to its ends.
  void Skip(double seconds);
  /// Return pose and time according to the path, which must exist; nullopt if it has no times.
  [[nodiscard]] CameraPose Pose() const { return path_->PoseAt(at_s_); }
  [[nodiscard]] std::optional<UtcTime> Utc() const { return path_->UtcAt(at_s_); }

 private:
  std::shared_ptr<const CameraPath> path_;
  double at_s_ = 0.0;
};

/// Direction of motion: heading clockwise from north, climb angle above the horizontal.
struct Course {
  double heading_rad, climb_rad;
};

/// Values for the instruments, in every mode.
struct FlightReadout {
  FlightMode mode = FlightMode::kFree;
  double speed_m_per_s = 0.0;           // over the ground, in the last frame
  double vertical_speed_m_per_s = 0.0;  // positive upwards
  double above_ground_m = 0.0;
  std::optional<Course> course;  // nullopt while the eye is at rest
  double speed_factor = 1.0;     // of the free camera, of track time, or of flight time (1 to 32)
  std::optional<AircraftReadout> aircraft;  // in aircraft mode
  std::string_view aircraft_name;           // "" in other modes
  std::string autopilot;                    // TextOf(AutopilotTargets)
};

class Pilot {
 public:
  /// Starts with a free camera.
  Pilot(const CameraPose& eye, const Ellipsoid& ellipsoid);

  [[nodiscard]] FlightMode mode() const { return mode_; }
  [[nodiscard]] const CameraPose& eye() const { return eye_; }

  /// Changes the mode at the current position. A track starts at its beginning, or where it was
  /// left. Returns the reason if the mode cannot be entered, otherwise nullopt.
  [[nodiscard]] std::optional<std::string> Enter(FlightMode mode, const GroundHeight& ground);
  /// Moves the eye to another position in the current mode; the mode kTrack changes to the free
  /// camera.
  void PutAt(const CameraPose& eye, const GroundHeight& ground);
  /// Raises the eye above ground whose height has become known.
  void KeepAbove(const GroundHeight& ground) { Show(ground); }
  /// Sets the track for kTrack, which starts at its beginning and in its own time. A null track
  /// removes it.
  /// @param lens  source of the field of view: the eye, or the track (a replay)
  enum class Lens { kOfEye, kOfTrack };
  void SetTrack(std::shared_ptr<const CameraPath> track, Lens lens = Lens::kOfEye);
  [[nodiscard]] const FollowedTrack& track() const { return track_; }
  /// Returns whether a track is followed with its own field of view.
  [[nodiscard]] bool Replays() const {
    return mode_ == FlightMode::kTrack && track_lens_ == Lens::kOfTrack;
  }

  /// Advances by a number of real seconds.
  void Advance(const PilotControls& controls, double seconds, const GroundHeight& ground);

  /// Increases (+1) or decreases (-1) the speed by a factor of 1.5: for the free camera between
  /// 1/64 and 64, for the track between 1/8 and 64. For the aircraft the factor is 2, between 1 and
  /// 32. At 32 it flies 32 s in a second.
  void StepSpeed(int step);
  /// Returns the ratio of aircraft or track time to real time; the clock of the scene runs with it.
  [[nodiscard]] double time_factor() const;
  /// Moves along the track, at most to its ends.
  void SkipTrack(double seconds) { track_.Skip(seconds); }
  /// Returns the time according to the track; nullopt in other modes.
  [[nodiscard]] std::optional<UtcTime> TrackUtc() const;

  void Zoom(double factor) { eye_ = Zoomed(eye_, factor); }
  void ResetView() { eye_.fov_rad = first_fov_rad_; }
  /// Turns the view ahead and levels wings and path; the autopilot keeps its targets.
  void Centre(const GroundHeight& ground);
  /// Raises the eye. An aircraft that is too slow gets enough speed to fly. A track does not move.
  void Lift(double height_m, const GroundHeight& ground);

  /// Return the aircraft; null in other modes.
  [[nodiscard]] PilotedAircraft* aircraft() {
    return mode_ == FlightMode::kAircraft ? &aircraft_ : nullptr;
  }
  [[nodiscard]] const PilotedAircraft* aircraft() const {
    return mode_ == FlightMode::kAircraft ? &aircraft_ : nullptr;
  }

  [[nodiscard]] FlightReadout Readout(const GroundHeight& ground) const;

 private:
  void RecordSpeed(const Place& before, double seconds);
  void LookAround(const PilotControls& controls);
  void Show(const GroundHeight& ground);

  Ellipsoid ellipsoid_;
  FlightMode mode_ = FlightMode::kFree;
  CameraPose eye_;
  double first_fov_rad_;
  double free_factor_ = 1.0, track_factor_ = 1.0, flight_factor_ = 1.0;
  double look_right_rad_ = 0.0, look_up_rad_ = 0.0;
  double speed_m_per_s_ = 0.0, vertical_speed_m_per_s_ = 0.0;
  std::optional<Course> course_;
  PilotedAircraft aircraft_;
  FollowedTrack track_;
  Lens track_lens_ = Lens::kOfEye;
};

}  // namespace alpenglow::viewer
