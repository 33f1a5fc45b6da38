// SPDX-License-Identifier: MIT
#include "viewer/flight/autopilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/number/gravity.h"

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
  constexpr double kSteepest = 0.2;  // sine
  return std::asin(std::clamp(climb_m_per_s / std::max(speed_m_per_s, 1.0), -kSteepest, kSteepest));
}

double ClimbToward(double height_m, double from_m, double speed_m_per_s) {
  constexpr double kTime_s = 6.0, kSteepest = 0.105;  // sine of 6 degrees
  const double most = kSteepest * speed_m_per_s;
  return std::clamp((height_m - from_m) / kTime_s, -most, most);
}

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
  constexpr double kPerSecond = 0.5;  // of a lever that is pushed
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

}  // namespace alpenglow::viewer
