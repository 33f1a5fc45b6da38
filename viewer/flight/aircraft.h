// SPDX-License-Identifier: MIT
// An aircraft that can be flown at once: a point of mass with wings, and a computer between the
// stick and the wings.
//
//   m dv/dt = T a + L u - D v/|v| + Y r + m g            forces
//   L = q S C_L,  D = q S (C_D0 + k C_L^2 + rise(Mach)),  Y = q S C_Y,beta beta,  q = rho |v|^2 / 2
//   rise = 20 (Mach - Mach_crit)^4                        Lock's law of the drag rise
//
// a is the nose's direction, u the lift's, r to the right of both. Wings that are banked by phi in
// level flight turn with g tan(phi) / |v|: nothing else makes the turn. Air is StandardAirAt, so
// wings carry less in thin air and engines pull less: a jet's thrust as the density, a piston's
// power as sigma - (1 - sigma) / 7.55 (Gagg and Ferrar's model, Gudmundsson (2014), General Aviation
// Aircraft Design, eq. 7-16). Gravity falls with the square of the distance. The earth does not
// turn under it: no wind, no Coriolis force.
// Formulas: Anderson (1999), Aircraft Performance and Design, chapters 3, 5 and 6; Lock's law: Gur,
// Mason and Schetz (2010), J. Aircraft 47(4), doi 10.2514/1.47557.
//
// The stick asks for load (pitch) and a rate of roll. Let go, it holds the path as steep and the
// bank as large as they are: wings within 5 degrees are levelled, more than 45 degrees comes back
// to 45, and a path within 1 degree of the horizon is levelled. Without power it slows down to some
// 1.2 times the stall speed and glides. Stalled wings give no more lift; they do not drop.
//
// Time goes by in steps of 1/120 s, whatever the frames are: flights do not depend on the frame
// rate.
#pragma once

#include <string_view>

#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

/// What kind of aircraft it is. Coefficients refer to the wing's area.
struct AircraftKind {
  std::string_view name;
  double mass_kg;
  double wing_area_m2;
  double zero_lift_drag;
  double induced_drag;        // k of C_D = C_D0 + k C_L^2
  double lift_slope_per_rad;  // of the angle of attack
  double cruise_lift;         // C_L at which the nose points along the path
  double least_lift, most_lift;
  double side_force_per_rad;  // of the slip, positive
  double thrust_N;            // at sea level; of a propeller at most
  double power_W;             // of a propeller at sea level, losses taken off; 0 for a jet
  double critical_mach;
  double least_load, most_load;  // in standard gravities
  double roll_rate_rad_per_s;
};

/// A light aircraft of the class of the Cessna 172: mass, area, drag and lift slope of LaRCsim's
/// c172 (linear model, 2300 lb); 160 hp at an efficiency of 0.7; loads of the normal category (14
/// CFR 23.337). Most lift: 1.5, of a clean wing.
inline constexpr AircraftKind kLightAircraft{
    "light aircraft", 1043.0, 16.17, 0.031, 0.054, 5.143, 0.31, -0.8, 1.5, 0.31,
    2400.0,           83.5e3, 0.65,  -1.52, 3.8,   1.2};
/// A small jet of the class of the Learjet 24: Roskam (1995), Airplane Flight Dynamics and
/// Automatic Flight Controls, part I, pp. 522-524; k of its aspect ratio 5.03 and a span efficiency
/// of 0.8. Most lift: 1.4, of a clean wing.
inline constexpr AircraftKind kSmallJet{"small jet", 5897.0, 21.37, 0.0216, 0.079,   5.84,
                                        0.41,        -0.7,   1.4,   0.73,   26.24e3, 0.0,
                                        0.78,        -1.0,   3.0,   1.2};

/// The jet above this height, and the light aircraft below, when a flight begins.
inline constexpr double kJetsFrom_m = 3500.0;
/// There is no air to fly in above this height; the jet glides down from it.
inline constexpr double kHighestStart_m = 18000.0;

/// Speed below which wings cannot carry the weight in level flight [m/s]:
/// sqrt(2 m g / (rho S C_L,max)).
[[nodiscard]] double StallSpeed(const AircraftKind& kind, double height_m);
/// A speed of comfort at a height [m/s]: level flight at the lift coefficient of the cruise, not
/// over the critical Mach number.
[[nodiscard]] double CruiseSpeed(const AircraftKind& kind, double height_m);

/// What hands and feet do, each in [-1, 1]; the brake in [0, 1].
struct Stick {
  double pitch_up = 0.0;
  double roll_right = 0.0;
  double yaw_right = 0.0;
  double throttle_up = 0.0;  // 1 opens the throttle in 2 s
  double brake = 0.0;
};

/// How it stands with the ground: rolling on wheels, scraping over it (a touch at more than 3 m/s,
/// not upright, or a slope of more than 30 degrees), or standing. Nothing breaks: full throttle
/// takes off again.
enum class GroundContact { kNone, kRolling, kScraping, kStanding };
/// "rolling", "scraping over the ground", "standing"; "" in the air.
[[nodiscard]] const char* NameOf(GroundContact contact);

/// All that a flight depends on. Directions are unit vectors.
struct AircraftState {
  Point<Ecef> place;
  Vector<Ecef> velocity;
  Vector<Ecef> ahead;     // along the path, and where it points when it stands
  Vector<Ecef> up;        // of the lift, across `ahead`
  double throttle = 0.0;  // in [0, 1]
  double load = 1.0;      // lift asked for, in weights at standard gravity
  double roll_rate_rad_per_s = 0.0;
  double slip_rad = 0.0;                            // nose to the right of the path
  double held_path_rad = 0.0, held_bank_rad = 0.0;  // with the stick let go
  bool stalled = false;
  GroundContact contact = GroundContact::kNone;
};

/// For instruments.
struct AircraftReadout {
  double speed_m_per_s;           // through the air and over the ground: there is no wind
  double indicated_m_per_s;       // times sqrt(rho / rho_0)
  double vertical_speed_m_per_s;  // up is positive
  double heading_rad;             // of the path, clockwise from north
  double path_rad, bank_rad;      // up and to the right are positive
  double load;                    // lift in weights at standard gravity
  double mach;
  double throttle;
  bool stalled;
  GroundContact contact;
};

/// Straight and level at a place and heading at CruiseSpeed, with the throttle that keeps it (or
/// full, where that is not enough).
[[nodiscard]] AircraftState LevelFlight(const AircraftKind& kind, const Ellipsoid& ellipsoid,
                                        const GeodeticPosition& place, double heading_rad);

/// The state a moment later. The step is short; over 1/60 s it gets coarse.
[[nodiscard]] AircraftState Stepped(const AircraftState& state, const AircraftKind& kind,
                                    const Ellipsoid& ellipsoid, const Stick& stick,
                                    const GroundHeight& ground, double step_s);

[[nodiscard]] AircraftReadout ReadoutOf(const AircraftState& state, const AircraftKind& kind,
                                        const Ellipsoid& ellipsoid);

/// The eye of its pilot, who looks away from the nose by these angles; the field of view is kept.
[[nodiscard]] Eye EyeIn(const AircraftState& state, const AircraftKind& kind,
                        const Ellipsoid& ellipsoid, double look_right_rad, double look_up_rad,
                        double fov_rad);

}  // namespace alpenglow::viewer
