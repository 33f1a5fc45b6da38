// SPDX-License-Identifier: MIT
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
#pragma once

#include <optional>
#include <string>

#include "viewer/flight/aircraft.h"

namespace alpenglow::viewer {

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

}  // namespace alpenglow::viewer
