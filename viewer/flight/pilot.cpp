// SPDX-License-Identifier: MIT
#include "viewer/flight/pilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/math/constants.h"
#include "viewer/flight/flight_recorder.h"

namespace alpenglow::viewer {
namespace {

double Toward(double value, double target, double most) {
  return value + std::clamp(target - value, -most, most);
}

double BankToward(double heading_rad, const AircraftReadout& now) {
  constexpr double kTime_s = 4.0, kMost_rad = 25.0 * kRadiansPerDegree;
  const double turn = std::remainder(heading_rad - now.heading_rad, 2.0 * kPi);
  const double bank = std::atan(turn * now.speed_m_per_s / (kTime_s * kStandardGravity_m_per_s2));
  return std::clamp(bank, -kMost_rad, kMost_rad);
}

double PathFor(double climb_m_per_s, double speed_m_per_s) {
  constexpr double kSteepest = 0.2;  // sine of the path angle
  return std::asin(std::clamp(climb_m_per_s / std::max(speed_m_per_s, 1.0), -kSteepest, kSteepest));
}

double ClimbToward(double height_m, double from_m, double speed_m_per_s) {
  constexpr double kTime_s = 6.0, kSteepest = 0.105;  // sine of 6 degrees
  const double most = kSteepest * speed_m_per_s;
  return std::clamp((height_m - from_m) / kTime_s, -most, most);
}

constexpr double kStep_s = 1.0 / 120.0;
constexpr double kOnGround_m = 15.0;  // below this height a flight begins on the wheels

}  // namespace

bool AutopilotTargets::HoldsAnything() const {
  return heading_rad || height_m || climb_m_per_s || speed_m_per_s || level_wings;
}

std::string TextOf(const AutopilotTargets& targets) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
  if (targets.heading_rad) {
    const double degrees = *targets.heading_rad / kRadiansPerDegree;
    add(fmt::format("HDG {:03.0f}", std::fmod(std::round(degrees) + 720.0, 360.0)));
  }
  if (targets.level_wings) add("LVL");
  if (targets.height_m) add(fmt::format("ALT {:.0f} m", *targets.height_m));
  if (targets.climb_m_per_s) add(fmt::format("V/S {:+.1f} m/s", *targets.climb_m_per_s));
  if (targets.speed_m_per_s) add(fmt::format("SPD {:.0f} m/s", *targets.speed_m_per_s));
  return text;
}

void Autopilot::Toggle(Hold hold, const AircraftReadout& now, double height_m) {
  const auto toggle = [](std::optional<double>& target, double value) {
    target = target ? std::nullopt : std::optional(value);
  };
  switch (hold) {
    case Hold::kHeading:
      toggle(targets_.heading_rad, now.heading_rad);
      targets_.level_wings = false;
      break;
    case Hold::kLevelWings:
      targets_.level_wings = !targets_.level_wings;
      targets_.heading_rad.reset();
      break;
    case Hold::kHeight:
      toggle(targets_.height_m, height_m);
      targets_.climb_m_per_s.reset();
      break;
    case Hold::kClimb:
      toggle(targets_.climb_m_per_s, now.vertical_speed_m_per_s);
      targets_.height_m.reset();
      break;
    case Hold::kSpeed:
      toggle(targets_.speed_m_per_s, now.speed_m_per_s);
      break;
  }
}

void Autopilot::MoveTargets(const Stick& hands, double step_s) {
  constexpr double kTurn_rad_per_s = 10.0 * kRadiansPerDegree, kClimb_m_per_s = 20.0;
  constexpr double kClimb_m_per_s2 = 2.0, kSpeed_m_per_s2 = 5.0;
  if (targets_.heading_rad) {
    *targets_.heading_rad = std::remainder(
        *targets_.heading_rad + kTurn_rad_per_s * hands.roll_right * step_s, 2.0 * kPi);
  }
  if (targets_.height_m) *targets_.height_m += kClimb_m_per_s * hands.pitch_up * step_s;
  if (targets_.climb_m_per_s) *targets_.climb_m_per_s += kClimb_m_per_s2 * hands.pitch_up * step_s;
  if (targets_.speed_m_per_s)
    *targets_.speed_m_per_s += kSpeed_m_per_s2 * hands.throttle_up * step_s;
}

void Autopilot::FlyPath(const AircraftReadout& now, double from_m, double step_s,
                        Flown& flown) const {
  const double bank_step = 8.0 * kRadiansPerDegree * step_s;
  const double path_step = 2.0 * kRadiansPerDegree * step_s;
  AircraftState& state = flown.state;
  if (targets_.heading_rad || targets_.level_wings) {
    const double bank = targets_.heading_rad ? BankToward(*targets_.heading_rad, now) : 0.0;
    state.held_bank_rad = Toward(state.held_bank_rad, bank, bank_step);
    flown.stick.roll_right = 0.0;
  }
  if (targets_.height_m || targets_.climb_m_per_s) {
    const double climb = targets_.height_m
                             ? ClimbToward(*targets_.height_m, from_m, now.speed_m_per_s)
                             : *targets_.climb_m_per_s;
    state.held_path_rad = Toward(state.held_path_rad, PathFor(climb, now.speed_m_per_s), path_step);
    flown.stick.pitch_up = 0.0;
  }
}

double Autopilot::ThrottleUp(const AircraftReadout& now, double step_s) const {
  constexpr double kPerSecond = 0.5;  // rate of a fully pushed lever
  const double before = speed_before_m_per_s_.value_or(now.speed_m_per_s);
  const double acceleration = (now.speed_m_per_s - before) / step_s;
  const double lacking = *targets_.speed_m_per_s - now.speed_m_per_s;
  return std::clamp((0.07 * lacking - 0.5 * acceleration) / kPerSecond, -1.0, 1.0);
}

Autopilot::Flown Autopilot::Fly(const AircraftState& state, const AircraftKind& kind,
                                const Ellipsoid& ellipsoid, const Stick& hands, double step_s) {
  Flown flown{state, hands};
  if (!targets_.HoldsAnything()) {
    speed_before_m_per_s_.reset();
    return flown;
  }
  MoveTargets(hands, step_s);
  const AircraftReadout now = ReadoutOf(state, kind, ellipsoid);
  FlyPath(now, GeodeticFromEcef(ellipsoid, state.place).height_m, step_s, flown);
  if (targets_.speed_m_per_s) flown.stick.throttle_up = ThrottleUp(now, step_s);
  speed_before_m_per_s_ = now.speed_m_per_s;
  return flown;
}

void PilotedAircraft::Begin(Place place, double heading_rad, const GroundHeight& ground) {
  const double ground_m = ground(place);
  const bool stands = place.height_m < ground_m + kOnGround_m;
  if (stands) place.height_m = ground_m + kStandingEye_m;
  kind_ = !stands && place.height_m > kJetsFrom_m ? kSmallJet : kLightAircraft;
  state_ = LevelFlight(kind_, ellipsoid_, place, heading_rad);
  if (stands) {
    state_.velocity = {};
    state_.throttle = 0.0;
    state_.contact = GroundContact::kStanding;
  }
  shown_ = state_;
  rest_s_ = 0.0;
}

void PilotedAircraft::LeaveTheGround(const GroundHeight& ground) {
  constexpr double kDeep_m = 30.0, kOver_m = 150.0;
  Place place = GeodeticFromEcef(ellipsoid_, state_.place);
  const double ground_m = ground(place);
  if (place.height_m > ground_m - kDeep_m) return;
  place.height_m = ground_m + kOver_m;
  state_.place = EcefFromGeodetic(ellipsoid_, place);
}

AircraftState PilotedAircraft::NextState(Autopilot& autopilot, const Stick& stick, double step_s,
                                         const GroundHeight& ground) const {
  const Autopilot::Flown flown = autopilot.Fly(state_, kind_, ellipsoid_, stick, step_s);
  return Stepped(flown.state, kind_, ellipsoid_, flown.stick, ground, step_s);
}

void PilotedAircraft::Fly(const Stick& stick, double seconds, const GroundHeight& ground) {
  LeaveTheGround(ground);
  rest_s_ += seconds;
  const auto steps = static_cast<std::int64_t>(rest_s_ / kStep_s);
  for (std::int64_t i = 0; i < steps; ++i) state_ = NextState(autopilot_, stick, kStep_s, ground);
  rest_s_ = std::max(rest_s_ - static_cast<double>(steps) * kStep_s, 0.0);
  Autopilot looking_on = autopilot_;
  shown_ = rest_s_ > 0.0 ? NextState(looking_on, stick, rest_s_, ground) : state_;
}

void PilotedAircraft::Lift(double height_m) {
  const AircraftReadout now = ReadoutOf(state_, kind_, ellipsoid_);
  Place place = GeodeticFromEcef(ellipsoid_, state_.place);
  place.height_m += height_m;
  const bool flies = now.speed_m_per_s > 1.3 * StallSpeed(kind_, place.height_m);
  if (flies) {
    state_.place = EcefFromGeodetic(ellipsoid_, place);
  } else {
    state_ = LevelFlight(kind_, ellipsoid_, place, now.heading_rad);
  }
  shown_ = state_;
}

void PilotedAircraft::Level() { state_.held_bank_rad = state_.held_path_rad = 0.0; }

void PilotedAircraft::SetThrottle(double share) {
  state_.throttle = shown_.throttle = std::clamp(share, 0.0, 1.0);
  AutopilotTargets targets = autopilot_.targets();
  targets.speed_m_per_s.reset();
  autopilot_.Set(targets);
}

void PilotedAircraft::Toggle(Autopilot::Hold hold) {
  autopilot_.Toggle(hold, ReadoutOf(state_, kind_, ellipsoid_),
                    GeodeticFromEcef(ellipsoid_, state_.place).height_m);
}

FollowedTrack::FollowedTrack(std::shared_ptr<const CameraPath> path)
    : path_(std::move(path)), at_s_(path_ ? path_->begin_s() : 0.0) {}

void FollowedTrack::Skip(double seconds) {
  if (path_) at_s_ = std::clamp(at_s_ + seconds, path_->begin_s(), path_->end_s());
}

Pilot::Pilot(const CameraPose& eye, const Ellipsoid& ellipsoid)
    : ellipsoid_(ellipsoid), eye_(eye), first_fov_rad_(eye.fov_rad), aircraft_(ellipsoid) {}

void Pilot::SetTrack(std::shared_ptr<const CameraPath> track, Lens lens) {
  track_ = FollowedTrack(std::move(track));
  track_lens_ = lens;
  track_factor_ = 1.0;
  if (!track_.exists() && mode_ == FlightMode::kTrack) mode_ = FlightMode::kFree;
}

std::optional<std::string> Pilot::Enter(FlightMode mode, const GroundHeight& ground) {
  if (mode == mode_) return std::nullopt;
  if (mode == FlightMode::kTrack && !track_.exists()) return "there is no track to follow";
  if (mode == FlightMode::kAircraft && eye_.place.height_m > kHighestStart_m) {
    return "there is no air to fly in over 18 km";
  }
  look_right_rad_ = look_up_rad_ = 0.0;
  aircraft_.autopilot().Release();
  mode_ = mode;
  if (mode == FlightMode::kAircraft) aircraft_.Begin(eye_.place, eye_.heading_rad, ground);
  if (mode == FlightMode::kFree) eye_.roll_rad = 0.0;
  Show(ground);
  return std::nullopt;
}

void Pilot::PutAt(const CameraPose& eye, const GroundHeight& ground) {
  eye_ = eye;
  if (mode_ == FlightMode::kTrack || eye.place.height_m > kHighestStart_m)
    mode_ = FlightMode::kFree;
  look_right_rad_ = look_up_rad_ = 0.0;
  aircraft_.autopilot().Release();
  if (mode_ == FlightMode::kAircraft) aircraft_.Begin(eye.place, eye.heading_rad, ground);
  Show(ground);
}

void Pilot::Advance(const PilotControls& controls, double seconds, const GroundHeight& ground) {
  const Place before = eye_.place;
  LookAround(controls);
  if (mode_ == FlightMode::kFree) {
    eye_ = FreeFlight(eye_, controls.camera, ellipsoid_, ground, free_factor_, seconds);
  } else if (mode_ == FlightMode::kAircraft) {
    aircraft_.Fly(controls.stick, flight_factor_ * seconds, ground);
  } else {
    SkipTrack(track_factor_ * seconds);
  }
  Show(ground);
  if (seconds > 0.0) RecordSpeed(before, seconds);
}

void Pilot::RecordSpeed(const Place& before, double seconds) {
  constexpr double kStands_m_per_s = 0.5;
  const LocalFrame frame(ellipsoid_, before);
  const glm::dvec3 way = frame.EnuFromGeodetic(eye_.place).xyz;
  speed_m_per_s_ = glm::length(way) / seconds;
  vertical_speed_m_per_s_ = (eye_.place.height_m - before.height_m) / seconds;
  course_.reset();
  if (speed_m_per_s_ < kStands_m_per_s) return;
  const double climb = vertical_speed_m_per_s_ / speed_m_per_s_;
  course_ = Course{std::atan2(way.x, way.y), std::asin(std::clamp(climb, -1.0, 1.0))};
}

void Pilot::LookAround(const PilotControls& controls) {
  const double right_rad = controls.look_right * eye_.fov_rad;
  const double up_rad = controls.look_up * eye_.fov_rad;
  if (mode_ == FlightMode::kFree) {
    eye_ = Turned(eye_, right_rad, up_rad);
    return;
  }
  look_right_rad_ = std::remainder(look_right_rad_ + right_rad, 2.0 * kPi);
  look_up_rad_ = std::clamp(look_up_rad_ + up_rad, -0.5 * kPi, 0.5 * kPi);
}

void Pilot::Show(const GroundHeight& ground) {
  if (mode_ == FlightMode::kAircraft) {
    eye_ = aircraft_.EyeOfPilot(look_right_rad_, look_up_rad_, eye_.fov_rad);
  } else if (mode_ == FlightMode::kTrack) {
    const double fov_rad = eye_.fov_rad;
    eye_ = Turned(track_.Pose(), look_right_rad_, look_up_rad_);
    if (track_lens_ == Lens::kOfEye) eye_.fov_rad = fov_rad;
  }
  const double ground_m = ground(eye_.place);
  const double clearance_m = mode_ == FlightMode::kFree ? ClearanceOf(eye_, ground_m)
                             : Replays()                ? kLowestEye_m
                                                        : kStandingEye_m;
  eye_ = KeptAbove(eye_, ground_m, clearance_m);
}

void Pilot::StepSpeed(int step) {
  const auto stepped = [&](double factor, double by, double least, double most) {
    return std::clamp(factor * std::pow(by, step), least, most);
  };
  if (mode_ == FlightMode::kFree) free_factor_ = stepped(free_factor_, 1.5, 1.0 / 64.0, 64.0);
  if (mode_ == FlightMode::kTrack) track_factor_ = stepped(track_factor_, 1.5, 0.125, 64.0);
  if (mode_ == FlightMode::kAircraft) flight_factor_ = stepped(flight_factor_, 2.0, 1.0, 32.0);
}

double Pilot::time_factor() const {
  return mode_ == FlightMode::kAircraft ? flight_factor_
         : mode_ == FlightMode::kTrack  ? track_factor_
                                        : 1.0;
}

std::optional<UtcTime> Pilot::TrackUtc() const {
  return mode_ == FlightMode::kTrack ? track_.Utc() : std::nullopt;
}

void Pilot::Centre(const GroundHeight& ground) {
  look_right_rad_ = look_up_rad_ = 0.0;
  aircraft_.Level();
  if (mode_ == FlightMode::kFree) eye_.roll_rad = eye_.pitch_rad = 0.0;
  Show(ground);
}

void Pilot::Lift(double height_m, const GroundHeight& ground) {
  if (mode_ == FlightMode::kTrack) return;
  eye_.place.height_m += height_m;
  if (mode_ == FlightMode::kAircraft) aircraft_.Lift(height_m);
  Show(ground);
}

FlightReadout Pilot::Readout(const GroundHeight& ground) const {
  FlightReadout readout;
  readout.mode = mode_;
  readout.speed_m_per_s = speed_m_per_s_;
  readout.vertical_speed_m_per_s = vertical_speed_m_per_s_;
  readout.above_ground_m = eye_.place.height_m - ground(eye_.place);
  readout.course = course_;
  readout.speed_factor = time_factor();
  if (mode_ == FlightMode::kFree) readout.speed_factor = free_factor_;
  if (mode_ == FlightMode::kAircraft) {
    readout.aircraft = aircraft_.Readout();
    readout.aircraft_name = aircraft_.name();
    readout.autopilot = TextOf(aircraft_.autopilot().targets());
    readout.speed_m_per_s = readout.aircraft->speed_m_per_s;
    readout.vertical_speed_m_per_s = readout.aircraft->vertical_speed_m_per_s;
  }
  return readout;
}

}  // namespace alpenglow::viewer
