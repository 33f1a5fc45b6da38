// SPDX-License-Identifier: MIT
// Provides an aircraft with a simple flight model: a point mass with wings, and a flight computer
// between the stick and the wings.
//
//   m dv/dt = T a + L u - D v/|v| + Y r + m g            forces
//   L = q S C_L,  D = q S (C_D0 + k C_L^2 + rise(Mach)),  Y = q S C_Y,beta beta,  q = rho |v|^2 / 2
//   rise = 20 (Mach - Mach_crit)^4                        Lock's law of the drag rise
//
// a is the direction of the nose, u that of the lift, and r points to the right of both. In level
// flight with bank angle phi the aircraft turns at the rate g tan(phi) / |v|; nothing else causes a
// turn. The air is StandardAirAt. In thin air wings therefore produce less lift and engines less
// thrust: the thrust of a jet is proportional to density, the power of a piston engine to
// sigma - (1 - sigma) / 7.55 (Gagg and Ferrar's model, Gudmundsson (2014), General Aviation
// Aircraft Design, eq. 7-16). Gravity decreases with the square of the distance. The earth does not
// rotate below the aircraft: there is no wind and no Coriolis force.
// Formulas: Anderson (1999), Aircraft Performance and Design, chapters 3, 5 and 6; Lock's law: Gur,
// Mason and Schetz (2010), J. Aircraft 47(4), doi 10.2514/1.47557.
//
// The stick controls the load factor (pitch) and the roll rate. When it is released, the computer
// holds the current path angle and bank angle: a bank within 5 degrees is levelled, a bank of more
// than 45 degrees is reduced to 45, and a path within 1 degree of the horizon is levelled. Without
// power the aircraft slows down to about 1.2 times the stall speed and glides. Stalled wings give
// no more lift; they do not drop.
//
// The time step is 1/120 s for every frame rate, so flights do not depend on the frame rate.
#pragma once

#include <string_view>

#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

/// Parameters of an aircraft type. Coefficients refer to the area of the wing.
struct AircraftKind {
  std::string_view name;
  double mass_kg;
  double wing_area_m2;
  double zero_lift_drag;
  double induced_drag;        // k of C_D = C_D0 + k C_L^2
  double lift_slope_per_rad;  // per radian of the angle of attack
  double cruise_lift;         // C_L at which the nose is aligned with the path
  double least_lift, most_lift;
  double side_force_per_rad;  // per radian of the slip, positive
  double thrust_N;            // at sea level; for a propeller the maximum
  double power_W;             // of a propeller at sea level, after losses; 0 for a jet
  double critical_mach;
  double least_load, most_load;  // in standard gravities
  double roll_rate_rad_per_s;
};

/// A light aircraft of the class of the Cessna 172: mass, area, drag and lift slope of LaRCsim's
/// c172 (linear model, 2300 lb); 160 hp at an efficiency of 0.7; load factors of the normal
/// category (14 CFR 23.337). Maximum lift coefficient: 1.5, for a clean wing.
inline constexpr AircraftKind kLightAircraft{
    "light aircraft", 1043.0, 16.17, 0.031, 0.054, 5.143, 0.31, -0.8, 1.5, 0.31,
    2400.0,           83.5e3, 0.65,  -1.52, 3.8,   1.2};
/// A small jet of the class of the Learjet 24: Roskam (1995), Airplane Flight Dynamics and
/// Automatic Flight Controls, part I, pp. 522-524; k from its aspect ratio 5.03 and a span
/// efficiency of 0.8. Maximum lift coefficient: 1.4, for a clean wing.
inline constexpr AircraftKind kSmallJet{"small jet", 5897.0, 21.37, 0.0216, 0.079,   5.84,
                                        0.41,        -0.7,   1.4,   0.73,   26.24e3, 0.0,
                                        0.78,        -1.0,   3.0,   1.2};

/// Above this height a flight begins in the jet, below it in the light aircraft.
inline constexpr double kJetsFrom_m = 3500.0;
/// A flight cannot begin above this height, because the air is too thin; a jet glides down from it.
inline constexpr double kHighestStart_m = 18000.0;

/// Returns the speed below which the wings cannot carry the weight in level flight [m/s]:
/// sqrt(2 m g / (rho S C_L,max)).
[[nodiscard]] double StallSpeed(const AircraftKind& kind, double height_m);
/// Returns the cruise speed at a height [m/s]: that of level flight at the cruise lift coefficient,
/// at most the critical Mach number.
[[nodiscard]] double CruiseSpeed(const AircraftKind& kind, double height_m);

/// Inputs of the pilot, each in [-1, 1]; the brake in [0, 1].
struct Stick {
  double pitch_up = 0.0;
  double roll_right = 0.0;
  double yaw_right = 0.0;
  double throttle_up = 0.0;  // 1 opens the throttle fully in 2 s
  double brake = 0.0;
};

/// Contact with the ground: rolling on wheels, scraping (a touchdown at more than 3 m/s, an
/// attitude that is not upright, or a slope of more than 30 degrees), or standing. Nothing breaks:
/// with full throttle the aircraft takes off again.
enum class GroundContact { kNone, kRolling, kScraping, kStanding };
/// Returns "rolling", "scraping over the ground", "standing", or "" in the air.
[[nodiscard]] const char* NameOf(GroundContact contact);

/// Complete state of a flight. Directions are unit vectors.
struct AircraftState {
  Point<Ecef> place;
  Vector<Ecef> velocity;
  Vector<Ecef> ahead;     // direction along the path; direction of the nose when standing
  Vector<Ecef> up;        // direction of the lift, perpendicular to `ahead`
  double throttle = 0.0;  // in [0, 1]
  double load = 1.0;      // commanded lift, in weights at standard gravity
  double roll_rate_rad_per_s = 0.0;
  double slip_rad = 0.0;                            // angle of the nose to the right of the path
  double held_path_rad = 0.0, held_bank_rad = 0.0;  // held while the stick is released
  bool stalled = false;
  GroundContact contact = GroundContact::kNone;
};

/// Values for the instruments.
struct AircraftReadout {
  double speed_m_per_s;           // air speed, which equals ground speed: there is no wind
  double indicated_m_per_s;       // speed times sqrt(rho / rho_0)
  double vertical_speed_m_per_s;  // positive upwards
  double heading_rad;             // of the path, clockwise from north
  double path_rad, bank_rad;      // positive upwards and to the right
  double load;                    // lift in weights at standard gravity
  double mach;
  double throttle;
  bool stalled;
  GroundContact contact;
};

/// Returns straight and level flight at a place and heading at CruiseSpeed, with the throttle that
/// maintains it, or full throttle if that is insufficient.
[[nodiscard]] AircraftState LevelFlight(const AircraftKind& kind, const Ellipsoid& ellipsoid,
                                        const Place& place, double heading_rad);

/// Returns the state after a short step. Steps of more than 1/60 s are inaccurate.
[[nodiscard]] AircraftState Stepped(const AircraftState& state, const AircraftKind& kind,
                                    const Ellipsoid& ellipsoid, const Stick& stick,
                                    const GroundHeight& ground, double step_s);

[[nodiscard]] AircraftReadout ReadoutOf(const AircraftState& state, const AircraftKind& kind,
                                        const Ellipsoid& ellipsoid);

/// Returns the eye of the pilot, whose view is turned from the nose by these angles; the field of
/// view is kept.
[[nodiscard]] CameraPose EyeIn(const AircraftState& state, const AircraftKind& kind,
                               const Ellipsoid& ellipsoid, double look_right_rad,
                               double look_up_rad, double fov_rad);

}  // namespace alpenglow::viewer
