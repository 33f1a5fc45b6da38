// SPDX-License-Identifier: MIT
#include "viewer/flight/pilot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/number/constants.h"
#include "viewer/flight/flight_recorder.h"

namespace alpenglow::viewer {
namespace {

constexpr double kStep_s = 1.0 / 120.0;
constexpr double kStanding_m = 1.5;  // of the eye over the ground
// Of a replay, which goes as low as it was flown; less and rounding would show land from below.
constexpr double kReplayed_m = 0.1;
constexpr double kOnGround_m = 15.0;  // so near to it a flight begins on its wheels

}  // namespace

Pilot::Pilot(const Eye& eye, const Ellipsoid& ellipsoid)
    : ellipsoid_(ellipsoid), eye_(eye), first_fov_rad_(eye.fov_rad) {}

void Pilot::SetTrack(std::shared_ptr<const CameraPath> track, Lens lens) {
  track_ = std::move(track);
  track_lens_ = lens;
  track_s_ = track_ ? track_->begin_s() : 0.0;
  track_factor_ = 1.0;
  if (!track_ && mode_ == FlightMode::kTrack) mode_ = FlightMode::kFree;
}

std::optional<std::string> Pilot::Enter(FlightMode mode, const GroundHeight& ground) {
  if (mode == mode_) return std::nullopt;
  if (mode == FlightMode::kTrack && !track_) return "there is no track to follow";
  if (mode == FlightMode::kAircraft && eye_.place.height_m > kHighestStart_m) {
    return "there is no air to fly in over 18 km";
  }
  look_right_rad_ = look_up_rad_ = 0.0;
  autopilot_.Release();
  mode_ = mode;
  if (mode == FlightMode::kAircraft) BeginFlight(eye_.heading_rad, ground);
  if (mode == FlightMode::kFree) eye_.roll_rad = 0.0;
  Show(ground);
  return std::nullopt;
}

void Pilot::BeginFlight(double heading_rad, const GroundHeight& ground) {
  const double ground_m = ground(eye_.place);
  GeodeticPosition place = eye_.place;
  const bool stands = place.height_m < ground_m + kOnGround_m;
  if (stands) place.height_m = ground_m + kStanding_m;
  kind_ = !stands && place.height_m > kJetsFrom_m ? kSmallJet : kLightAircraft;
  aircraft_ = LevelFlight(kind_, ellipsoid_, place, heading_rad);
  if (stands) {
    aircraft_.velocity = {};
    aircraft_.throttle = 0.0;
    aircraft_.contact = GroundContact::kStanding;
  }
  shown_ = aircraft_;
  rest_s_ = 0.0;
}

void Pilot::PutAt(const Eye& eye, const GroundHeight& ground) {
  eye_ = eye;
  if (mode_ == FlightMode::kTrack || eye.place.height_m > kHighestStart_m)
    mode_ = FlightMode::kFree;
  look_right_rad_ = look_up_rad_ = 0.0;
  autopilot_.Release();
  if (mode_ == FlightMode::kAircraft) BeginFlight(eye.heading_rad, ground);
  Show(ground);
}

void Pilot::Advance(const PilotControls& controls, double seconds, const GroundHeight& ground) {
  const GeodeticPosition before = eye_.place;
  LookAround(controls);
  if (mode_ == FlightMode::kFree) {
    eye_ = FreeFlight(eye_, controls.camera, ellipsoid_, ground, free_factor_, seconds);
  } else if (mode_ == FlightMode::kAircraft) {
    LeaveTheGround(ground);
    FlyAircraft(controls.stick, flight_factor_ * seconds, ground);
  } else {
    SkipTrack(track_factor_ * seconds);
  }
  Show(ground);
  if (seconds > 0.0) NoteSpeed(before, seconds);
}

void Pilot::NoteSpeed(const GeodeticPosition& before, double seconds) {
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

void Pilot::LeaveTheGround(const GroundHeight& ground) {
  constexpr double kDeep_m = 30.0, kOver_m = 150.0;
  GeodeticPosition place = GeodeticFromEcef(ellipsoid_, aircraft_.place);
  const double ground_m = ground(place);
  if (place.height_m > ground_m - kDeep_m) return;
  place.height_m = ground_m + kOver_m;
  aircraft_.place = EcefFromGeodetic(ellipsoid_, place);
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

AircraftState Pilot::NextState(Autopilot& autopilot, const Stick& stick, double step_s,
                               const GroundHeight& ground) const {
  const Autopilot::Flown flown = autopilot.Fly(aircraft_, kind_, ellipsoid_, stick, step_s);
  return Stepped(flown.state, kind_, ellipsoid_, flown.stick, ground, step_s);
}

void Pilot::FlyAircraft(const Stick& stick, double seconds, const GroundHeight& ground) {
  rest_s_ += seconds;
  const auto steps = static_cast<std::int64_t>(rest_s_ / kStep_s);
  for (std::int64_t i = 0; i < steps; ++i) {
    aircraft_ = NextState(autopilot_, stick, kStep_s, ground);
  }
  rest_s_ = std::max(rest_s_ - static_cast<double>(steps) * kStep_s, 0.0);
  Autopilot looking_on = autopilot_;
  shown_ = rest_s_ > 0.0 ? NextState(looking_on, stick, rest_s_, ground) : aircraft_;
}

void Pilot::Show(const GroundHeight& ground) {
  if (mode_ == FlightMode::kAircraft) {
    eye_ = EyeIn(shown_, kind_, ellipsoid_, look_right_rad_, look_up_rad_, eye_.fov_rad);
  } else if (mode_ == FlightMode::kTrack) {
    const double fov_rad = eye_.fov_rad;
    eye_ = Turned(EyeOf(track_->PoseAt(track_s_)), look_right_rad_, look_up_rad_);
    if (track_lens_ == Lens::kOfEye) eye_.fov_rad = fov_rad;
  }
  eye_ = KeptAbove(eye_, ground(eye_.place), Replays() ? kReplayed_m : kStanding_m);
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

void Pilot::SkipTrack(double seconds) {
  if (track_) track_s_ = std::clamp(track_s_ + seconds, track_->begin_s(), track_->end_s());
}

std::optional<UtcInstant> Pilot::TrackUtc() const {
  return mode_ == FlightMode::kTrack ? track_->UtcAt(track_s_) : std::nullopt;
}

void Pilot::Centre(const GroundHeight& ground) {
  look_right_rad_ = look_up_rad_ = 0.0;
  aircraft_.held_bank_rad = 0.0;
  aircraft_.held_path_rad = 0.0;
  if (mode_ == FlightMode::kFree) eye_.roll_rad = eye_.pitch_rad = 0.0;
  Show(ground);
}

void Pilot::Lift(double height_m, const GroundHeight& ground) {
  if (mode_ == FlightMode::kTrack) return;
  eye_.place.height_m += height_m;
  if (mode_ == FlightMode::kAircraft) {
    const AircraftState before = aircraft_;
    const AircraftReadout now = ReadoutOf(before, kind_, ellipsoid_);
    GeodeticPosition place = GeodeticFromEcef(ellipsoid_, before.place);
    place.height_m += height_m;
    const bool flies = now.speed_m_per_s > 1.3 * StallSpeed(kind_, place.height_m);
    if (flies) {
      aircraft_.place = EcefFromGeodetic(ellipsoid_, place);
    } else {
      aircraft_ = LevelFlight(kind_, ellipsoid_, place, now.heading_rad);
    }
    shown_ = aircraft_;
  }
  Show(ground);
}

void Pilot::SetThrottle(double share) {
  if (mode_ != FlightMode::kAircraft) return;
  aircraft_.throttle = shown_.throttle = std::clamp(share, 0.0, 1.0);
  AutopilotTargets targets = autopilot_.targets();
  targets.speed_m_per_s.reset();
  autopilot_.Set(targets);
}

void Pilot::ToggleHold(Autopilot::Hold hold) {
  if (mode_ != FlightMode::kAircraft) return;
  autopilot_.Toggle(hold, ReadoutOf(aircraft_, kind_, ellipsoid_),
                    GeodeticFromEcef(ellipsoid_, aircraft_.place).height_m);
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
    readout.aircraft = ReadoutOf(shown_, kind_, ellipsoid_);
    readout.aircraft_name = kind_.name;
    readout.autopilot = TextOf(autopilot_.targets());
    readout.speed_m_per_s = readout.aircraft->speed_m_per_s;
    readout.vertical_speed_m_per_s = readout.aircraft->vertical_speed_m_per_s;
  }
  return readout;
}

}  // namespace alpenglow::viewer
