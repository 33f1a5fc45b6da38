// SPDX-License-Identifier: MIT
#include "viewer/flight/aircraft.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/names.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/standard_air.h"

namespace alpenglow::viewer {
namespace {

constexpr double kWheels_m = 1.5;   // height of the pilot's eye above the ground, standing
constexpr double kHandsOff = 0.02;  // as a fraction of the stick's travel
constexpr double kSeaDensity_kg_per_m3 = 1.225;

/// Position and air around the aircraft.
struct Surroundings {
  Place place;
  glm::dvec3 up, north, east;  // at the ellipsoid, earth-fixed
  double gravity_m_per_s2, radius_m;
  StandardAir air;
};

Surroundings SurroundingsAt(const Ellipsoid& ellipsoid, const Point<Ecef>& point) {
  const Place place = GeodeticFromEcef(ellipsoid, point);
  const double sin_lat = std::sin(place.latitude_rad()), cos_lat = std::cos(place.latitude_rad());
  const double sin_lon = std::sin(place.longitude_rad()), cos_lon = std::cos(place.longitude_rad());
  const double radius_m = OsculatingRadius(ellipsoid, place.latitude_rad()) + place.height_m;
  const double share = 1.0 - place.height_m / radius_m;  // of the distance from the centre
  return {place,
          {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat},
          {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
          {-sin_lon, cos_lon, 0.0},
          kStandardGravity_m_per_s2 * share * share,
          radius_m,
          StandardAirAt(place.height_m)};
}

/// Returns the part of `vector` perpendicular to a unit vector, normalised; `otherwise` if that
/// part is zero.
glm::dvec3 UnitAcross(const glm::dvec3& vector, const glm::dvec3& along,
                      const glm::dvec3& otherwise) {
  const glm::dvec3 across = vector - glm::dot(vector, along) * along;
  const double length = glm::length(across);
  return length < 1e-9 ? otherwise : across / length;
}

glm::dvec3 CourseOf(const AircraftState& state) {
  const double speed = glm::length(state.velocity.xyz);
  return speed < 1e-6 ? state.ahead.xyz : state.velocity.xyz / speed;
}

double PathOf(const AircraftState& state, const Surroundings& here) {
  return std::asin(std::clamp(glm::dot(state.ahead.xyz, here.up), -1.0, 1.0));
}

double BankOf(const AircraftState& state, const Surroundings& here) {
  const glm::dvec3 right = glm::cross(state.ahead.xyz, state.up.xyz);
  return std::atan2(-glm::dot(right, here.up), glm::dot(state.up.xyz, here.up));
}

double ThrustAt(const AircraftKind& kind, const Surroundings& here, double speed) {
  const double sigma = here.air.density_kg_per_m3 / kSeaDensity_kg_per_m3;
  if (kind.power_W == 0.0) return kind.thrust_N * sigma;
  const double share = std::max(sigma - (1.0 - sigma) / 7.55, 0.0);
  return share * std::min(kind.thrust_N, kind.power_W / std::max(speed, 1.0));
}

double DragCoefficient(const AircraftKind& kind, double lift_coefficient, double mach) {
  const double over = std::max(mach - kind.critical_mach, 0.0);
  return kind.zero_lift_drag + kind.induced_drag * lift_coefficient * lift_coefficient +
         20.0 * over * over * over * over;
}

/// Returns the dynamic pressure times the area of the wing [N], for the part of the air flow from
/// ahead.
double PressureOnWing(const AircraftState& state, const AircraftKind& kind,
                      const Surroundings& here) {
  const double speed = glm::length(state.velocity.xyz);
  const double straight = std::max(glm::dot(CourseOf(state), state.ahead.xyz), 0.0);
  return 0.5 * here.air.density_kg_per_m3 * speed * speed * kind.wing_area_m2 * straight;
}

double LiftCoefficient(const AircraftState& state, const AircraftKind& kind,
                       const Surroundings& here) {
  const double pressure_N = PressureOnWing(state, kind, here);
  const double lift_N = state.load * kind.mass_kg * kStandardGravity_m_per_s2;
  if (pressure_N < 1.0) return 0.0;
  return std::clamp(lift_N / pressure_N, kind.least_lift, kind.most_lift);
}

glm::dvec3 Acceleration(const AircraftState& state, const AircraftKind& kind,
                        const Ellipsoid& ellipsoid) {
  const Surroundings here = SurroundingsAt(ellipsoid, state.place);
  const double speed = glm::length(state.velocity.xyz);
  const glm::dvec3 direction = CourseOf(state);
  const glm::dvec3 lift = UnitAcross(state.up.xyz, direction, state.up.xyz);
  const double pressure_N = PressureOnWing(state, kind, here);
  const double coefficient = LiftCoefficient(state, kind, here);
  const double drag = DragCoefficient(kind, coefficient, speed / here.air.sound_m_per_s);
  // Drag is independent of the direction of the air flow.
  const double drag_N = 0.5 * here.air.density_kg_per_m3 * speed * speed * kind.wing_area_m2 * drag;
  const glm::dvec3 force =
      state.throttle * ThrustAt(kind, here, speed) * state.ahead.xyz +
      pressure_N * coefficient * lift - drag_N * direction +
      pressure_N * kind.side_force_per_rad * state.slip_rad * glm::cross(direction, lift);
  return force / kind.mass_kg - here.gravity_m_per_s2 * here.up;
}

double Followed(double value, double target, double time_s, double step_s) {
  return target + (value - target) * std::exp(-step_s / time_s);
}

/// Returns the load factor that keeps the path angle. A bank of more than 60 degrees would need
/// more than twice the weight, so there the path bends down.
double LoadOfSteadyPath(const AircraftState& state, const Surroundings& here) {
  const double cos_bank = std::cos(BankOf(state, here));
  const double cos_path = std::cos(PathOf(state, here));
  const double speed = glm::length(state.velocity.xyz) * cos_path;
  const double weight =
      (here.gravity_m_per_s2 * cos_path - speed * speed / here.radius_m * cos_path) /
      kStandardGravity_m_per_s2;
  const double share = cos_bank > 0.5 ? 1.0 / cos_bank : std::max(4.0 * cos_bank, -1.0);
  return weight * share;
}

/// Returns the angle that is held when the stick is released: 0 for a small angle, otherwise the
/// angle clamped to a maximum.
double HeldAngle(double angle_rad, double level_deg, double most_deg) {
  if (std::abs(angle_rad) < level_deg * kRadiansPerDegree) return 0.0;
  return std::clamp(angle_rad, -most_deg * kRadiansPerDegree, most_deg * kRadiansPerDegree);
}

/// Output of the flight computer.
struct Demand {
  double load, roll_rate_rad_per_s, held_path_rad, held_bank_rad;
  bool stalled;
};

/// Returns the difference between 1.25 times the stall speed and the speed, in stall speeds, at
/// least 0.
double SpeedLacking(double wing_limit, double load) {
  constexpr double kSlowest = 1.25;
  return std::max(kSlowest - std::sqrt(wing_limit / std::max(load, 0.5)), 0.0);
}

void HoldPath(const AircraftState& state, const AircraftKind& kind, const Surroundings& here,
              double wing_limit, double step_s, Demand& demand) {
  constexpr double kPerSecond = 0.8, kSteeper_rad = 1.5, kForgetPerSecond = 4.0;
  const double speed = glm::length(state.velocity.xyz);
  // Without power the aircraft glides: the path is steeper in proportion to the missing speed.
  const double lacking = SpeedLacking(wing_limit, demand.load);
  const double path = std::max(state.held_path_rad - kSteeper_rad * lacking, -0.45 * kPi);
  const double back = kPerSecond * (path - PathOf(state, here)) * speed / kStandardGravity_m_per_s2;
  demand.load = std::clamp(demand.load + std::clamp(back, -1.0, 1.0), kind.least_load,
                           std::min(kind.most_load, wing_limit));
  // The held climb angle decays towards level flight if the aircraft cannot maintain it.
  demand.held_path_rad = state.held_path_rad > 0.0
                             ? state.held_path_rad * std::exp(-kForgetPerSecond * lacking * step_s)
                             : state.held_path_rad;
}

void DemandLoad(const AircraftState& state, const AircraftKind& kind, const Surroundings& here,
                double pitch_up, double step_s, Demand& demand) {
  const double wing_limit = PressureOnWing(state, kind, here) * kind.most_lift /
                            (kind.mass_kg * kStandardGravity_m_per_s2);
  demand.load = LoadOfSteadyPath(state, here);
  if (std::abs(pitch_up) < kHandsOff) {
    HoldPath(state, kind, here, wing_limit, step_s, demand);
    demand.stalled = false;
    return;
  }
  const double end = pitch_up > 0.0 ? kind.most_load : kind.least_load;
  demand.load += std::abs(pitch_up) * (end - demand.load);
  demand.stalled = demand.load > wing_limit;
  demand.load = std::min(demand.load, wing_limit);
  demand.held_path_rad = HeldAngle(PathOf(state, here), 1.0, 60.0);
}

void DemandRoll(const AircraftState& state, const AircraftKind& kind, const Surroundings& here,
                const Stick& stick, Demand& demand) {
  constexpr double kSteepest_rad = 75.0 * kRadiansPerDegree;
  constexpr double kPerSecond = 1.5;
  const double bank = BankOf(state, here);
  const double roll_right = std::clamp(stick.roll_right, -1.0, 1.0);
  demand.roll_rate_rad_per_s = roll_right * kind.roll_rate_rad_per_s;
  demand.held_bank_rad = HeldAngle(bank, 5.0, 45.0);
  if (std::abs(roll_right) >= kHandsOff) return;
  demand.held_bank_rad = state.held_bank_rad;
  // Do not hold the bank on a vertical path, where it is undefined, or while the stick is pulled
  // hard for aerobatics.
  constexpr double kFigure = 0.5;
  if (std::abs(PathOf(state, here)) > kSteepest_rad || std::abs(stick.pitch_up) > kFigure) return;
  const double most = 0.5 * kind.roll_rate_rad_per_s;
  demand.roll_rate_rad_per_s =
      std::clamp(kPerSecond * std::remainder(demand.held_bank_rad - bank, 2.0 * kPi), -most, most);
}

/// Applies stick, computer, servos and engine: the state follows the commands with a delay.
AircraftState Commanded(const AircraftState& state, const AircraftKind& kind,
                        const Surroundings& here, const Stick& stick, double step_s) {
  constexpr double kThrottlePerSecond = 0.5, kMostSlip_rad = 10.0 * kRadiansPerDegree;
  Demand demand{};
  DemandLoad(state, kind, here, std::clamp(stick.pitch_up, -1.0, 1.0), step_s, demand);
  DemandRoll(state, kind, here, stick, demand);
  AircraftState next = state;
  next.load = Followed(state.load, demand.load, 0.25, step_s);
  next.roll_rate_rad_per_s =
      Followed(state.roll_rate_rad_per_s, demand.roll_rate_rad_per_s, 0.15, step_s);
  next.slip_rad = Followed(state.slip_rad, kMostSlip_rad * stick.yaw_right, 0.4, step_s);
  next.throttle =
      std::clamp(state.throttle + kThrottlePerSecond * stick.throttle_up * step_s, 0.0, 1.0);
  next.held_path_rad = demand.held_path_rad;
  next.held_bank_rad = demand.held_bank_rad;
  next.stalled = demand.stalled;
  return next;
}

/// Integrates one step by the midpoint rule: the position error per second is (step)^2 times the
/// third derivative / 24.
AircraftState Moved(const AircraftState& state, const AircraftKind& kind,
                    const Ellipsoid& ellipsoid, double step_s) {
  AircraftState middle = state;
  middle.place.xyz += 0.5 * step_s * state.velocity.xyz;
  middle.velocity.xyz += 0.5 * step_s * Acceleration(state, kind, ellipsoid);
  AircraftState next = state;
  next.place.xyz += step_s * middle.velocity.xyz;
  next.velocity.xyz += step_s * Acceleration(middle, kind, ellipsoid);
  return next;
}

glm::dvec3 TurnedAbout(const glm::dvec3& axis, double angle_rad, const glm::dvec3& vector) {
  return std::cos(angle_rad) * vector + std::sin(angle_rad) * glm::cross(axis, vector) +
         (1.0 - std::cos(angle_rad)) * glm::dot(axis, vector) * axis;
}

/// Turns the nose towards the path, like a weathercock. The wings turn with it without rolling
/// (parallel transport), and then roll at the commanded rate.
AircraftState Pointed(const AircraftState& state, double step_s) {
  constexpr double kFastest_rad_per_s = 2.5, kSlowest_m_per_s = 1.0;
  AircraftState next = state;
  const glm::dvec3 path = CourseOf(state);
  if (glm::length(state.velocity.xyz) > kSlowest_m_per_s) {
    const double apart = AngleBetween(state.ahead.xyz, path);
    const glm::dvec3 toward = UnitAcross(path, state.ahead.xyz, state.up.xyz);
    const double turn = std::min(apart, kFastest_rad_per_s * step_s);
    const glm::dvec3 axis = glm::cross(state.ahead.xyz, toward);
    next.ahead.xyz = glm::normalize(TurnedAbout(axis, turn, state.ahead.xyz));
    next.up.xyz = TurnedAbout(axis, turn, state.up.xyz);
  }
  next.up.xyz = UnitAcross(next.up.xyz, next.ahead.xyz, state.up.xyz);
  next.up.xyz =
      glm::normalize(TurnedAbout(next.ahead.xyz, state.roll_rate_rad_per_s * step_s, next.up.xyz));
  return next;
}

/// Returns the upward normal of the slope under a place.
glm::dvec3 SlopeNormal(const Ellipsoid& ellipsoid, const Surroundings& here,
                       const GroundHeight& ground) {
  constexpr double kStep_m = 5.0;
  const LocalFrame frame(ellipsoid, here.place);
  const auto at = [&](double east_m, double north_m) {
    // The sample point is high enough to be above ground of up to 45 degrees.
    return ground(frame.GeodeticFromEnu(Point<Enu>{{east_m, north_m, kStep_m}}));
  };
  const double east = (at(kStep_m, 0.0) - at(-kStep_m, 0.0)) / (2.0 * kStep_m);
  const double north = (at(0.0, kStep_m) - at(0.0, -kStep_m)) / (2.0 * kStep_m);
  return glm::normalize(here.up - east * here.east - north * here.north);
}

/// Returns the velocity after contact with the ground: a hard touchdown bounces, friction reduces
/// the speed, and a slow aircraft without power stops.
glm::dvec3 Braked(const AircraftState& state, const glm::dvec3& normal, bool hard, double brake,
                  double step_s) {
  constexpr double kBounce = 0.25, kRolling = 0.03, kBraking = 0.4, kScraping = 0.6;
  constexpr double kStanding_m_per_s = 0.3, kIdle = 0.05;
  const double inward = glm::dot(state.velocity.xyz, normal);
  const glm::dvec3 along = state.velocity.xyz - inward * normal;
  const double outward = inward < 0.0 && hard ? -kBounce * inward : std::max(inward, 0.0);
  const double speed = glm::length(along);
  const bool idle = state.throttle < kIdle;
  if (idle && speed < kStanding_m_per_s && outward < kStanding_m_per_s) return glm::dvec3(0.0);
  const double friction = hard ? kScraping : kRolling + kBraking * brake;
  const double lost = friction * kStandardGravity_m_per_s2 * step_s;
  return along * (std::max(speed - lost, 0.0) / std::max(speed, 1e-9)) + outward * normal;
}

AircraftState OnGround(const AircraftState& state, const Ellipsoid& ellipsoid,
                       const Surroundings& here, double ground_m, const GroundHeight& ground,
                       double brake, double step_s) {
  constexpr double kHard_m_per_s = 3.0, kUpright = 0.87;  // cosine of 30 degrees
  const glm::dvec3 normal = SlopeNormal(ellipsoid, here, ground);
  const bool hard = glm::dot(state.velocity.xyz, normal) < -kHard_m_per_s ||
                    glm::dot(state.up.xyz, normal) < kUpright ||
                    glm::dot(here.up, normal) < kUpright;
  AircraftState next = state;
  Place lifted = here.place;
  lifted.height_m = ground_m + kWheels_m;
  next.place = EcefFromGeodetic(ellipsoid, lifted);
  next.velocity.xyz = Braked(state, normal, hard, brake, step_s);
  // The aircraft settles on its wheels, and its new path is parallel to the slope.
  next.ahead.xyz = UnitAcross(state.ahead.xyz, normal, state.ahead.xyz);
  const double share = 1.0 - std::exp(-step_s / 0.3);
  next.up.xyz = UnitAcross(state.up.xyz + share * normal, next.ahead.xyz, state.up.xyz);
  next.held_path_rad = std::max(state.held_path_rad, 0.0);
  next.held_bank_rad = 0.0;
  next.contact = glm::length(next.velocity.xyz) == 0.0 ? GroundContact::kStanding
                 : hard                                ? GroundContact::kScraping
                                                       : GroundContact::kRolling;
  return next;
}

}  // namespace

const char* NameOf(GroundContact contact) {
  constexpr EnumNames kNames{{std::pair{GroundContact::kNone, ""},
                              {GroundContact::kRolling, "rolling"},
                              {GroundContact::kScraping, "scraping over the ground"},
                              {GroundContact::kStanding, "standing"}}};
  return kNames.Of(contact);
}

double StallSpeed(const AircraftKind& kind, double height_m) {
  return std::sqrt(
      2.0 * kind.mass_kg * kStandardGravity_m_per_s2 /
      (StandardAirAt(height_m).density_kg_per_m3 * kind.wing_area_m2 * kind.most_lift));
}

double CruiseSpeed(const AircraftKind& kind, double height_m) {
  return std::min(StallSpeed(kind, height_m) * std::sqrt(kind.most_lift / kind.cruise_lift),
                  kind.critical_mach * StandardAirAt(height_m).sound_m_per_s);
}

AircraftState LevelFlight(const AircraftKind& kind, const Ellipsoid& ellipsoid, const Place& place,
                          double heading_rad) {
  AircraftState state;
  state.place = EcefFromGeodetic(ellipsoid, place);
  const Surroundings here = SurroundingsAt(ellipsoid, state.place);
  state.ahead.xyz = std::cos(heading_rad) * here.north + std::sin(heading_rad) * here.east;
  state.up.xyz = here.up;
  const double speed = CruiseSpeed(kind, place.height_m);
  state.velocity.xyz = speed * state.ahead.xyz;
  state.load = LoadOfSteadyPath(state, here);
  const double drag_N =
      PressureOnWing(state, kind, here) *
      DragCoefficient(kind, LiftCoefficient(state, kind, here), speed / here.air.sound_m_per_s);
  state.throttle = std::clamp(drag_N / std::max(ThrustAt(kind, here, speed), 1e-3), 0.0, 1.0);
  return state;
}

AircraftState Stepped(const AircraftState& state, const AircraftKind& kind,
                      const Ellipsoid& ellipsoid, const Stick& stick, const GroundHeight& ground,
                      double step_s) {
  const Surroundings before = SurroundingsAt(ellipsoid, state.place);
  const AircraftState commanded = Commanded(state, kind, before, stick, step_s);
  AircraftState next = Pointed(Moved(commanded, kind, ellipsoid, step_s), step_s);
  const Surroundings here = SurroundingsAt(ellipsoid, next.place);
  const double ground_m = ground(here.place);
  next.contact = GroundContact::kNone;
  if (here.place.height_m >= ground_m + kWheels_m) return next;
  return OnGround(next, ellipsoid, here, ground_m, ground, std::clamp(stick.brake, 0.0, 1.0),
                  step_s);
}

AircraftReadout ReadoutOf(const AircraftState& state, const AircraftKind& kind,
                          const Ellipsoid& ellipsoid) {
  const Surroundings here = SurroundingsAt(ellipsoid, state.place);
  const double speed = glm::length(state.velocity.xyz);
  const double weight_N = kind.mass_kg * kStandardGravity_m_per_s2;
  return {speed,
          speed * std::sqrt(here.air.density_kg_per_m3 / kSeaDensity_kg_per_m3),
          glm::dot(state.velocity.xyz, here.up),
          std::atan2(glm::dot(state.ahead.xyz, here.east), glm::dot(state.ahead.xyz, here.north)),
          PathOf(state, here),
          BankOf(state, here),
          PressureOnWing(state, kind, here) * LiftCoefficient(state, kind, here) / weight_N,
          speed / here.air.sound_m_per_s,
          state.throttle,
          state.stalled,
          state.contact};
}

CameraPose EyeIn(const AircraftState& state, const AircraftKind& kind, const Ellipsoid& ellipsoid,
                 double look_right_rad, double look_up_rad, double fov_rad) {
  const Surroundings here = SurroundingsAt(ellipsoid, state.place);
  const double attack_rad =
      (LiftCoefficient(state, kind, here) - kind.cruise_lift) / kind.lift_slope_per_rad;
  const bool flies = state.contact == GroundContact::kNone;
  const glm::dvec3 right = glm::cross(state.ahead.xyz, state.up.xyz);
  const double up_rad = look_up_rad + (flies ? attack_rad : 0.0);
  const glm::dvec3 turned =
      TurnedAbout(state.up.xyz, -(look_right_rad + state.slip_rad), state.ahead.xyz);
  const glm::dvec3 side = TurnedAbout(state.up.xyz, -(look_right_rad + state.slip_rad), right);
  const glm::dvec3 forward = TurnedAbout(side, up_rad, turned);
  const glm::dvec3 up = glm::cross(side, forward);
  CameraPose eye{here.place};
  eye.fov_rad = fov_rad;
  eye.heading_rad = std::atan2(glm::dot(forward, here.east), glm::dot(forward, here.north));
  eye.pitch_rad = std::asin(std::clamp(glm::dot(forward, here.up), -1.0, 1.0));
  const glm::dvec3 level_right =
      std::cos(eye.heading_rad) * here.east - std::sin(eye.heading_rad) * here.north;
  eye.roll_rad =
      std::atan2(glm::dot(up, level_right), glm::dot(up, glm::cross(level_right, forward)));
  return eye;
}

}  // namespace alpenglow::viewer
