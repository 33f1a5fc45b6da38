// SPDX-License-Identifier: MIT
// The aircraft and its autopilot.
#include "viewer/flight/aircraft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/standard_air.h"
#include "viewer/flight/pilot.h"

namespace alpenglow::viewer {
namespace {

constexpr double kStep_s = 1.0 / 120.0;
constexpr double kG = kStandardGravity_m_per_s2;

double NoGround(const Place&) { return -1e5; }
double SeaLevel(const Place&) { return 0.0; }

struct Flown {
  AircraftKind kind = kLightAircraft;
  AircraftState state;
  GroundHeight ground = NoGround;

  explicit Flown(double height_m = 1000.0, const AircraftKind& of = kLightAircraft,
                 double heading_rad = 0.0)
      : kind(of),
        state(LevelFlight(of, kWgs84, CheckedPlace({46.0, 8.0, height_m}), heading_rad)) {}

  void Fly(double seconds, const Stick& stick = {}) {
    const int steps = static_cast<int>(std::lround(seconds / kStep_s));
    for (int i = 0; i < steps; ++i) state = Stepped(state, kind, kWgs84, stick, ground, kStep_s);
  }
  [[nodiscard]] AircraftReadout Read() const { return ReadoutOf(state, kind, kWgs84); }
  [[nodiscard]] Place Here() const { return GeodeticFromEcef(kWgs84, state.place); }
};

double Degrees(double radians) { return radians / kRadiansPerDegree; }

TEST(Aircraft, WithoutInputFliesStraightAndLevelForTenMinutes) {
  for (const AircraftKind& kind : {kLightAircraft, kSmallJet}) {
    Flown flown(1000.0, kind, 1.0);
    flown.Fly(600.0);
    EXPECT_NEAR(flown.Here().height_m, 1000.0, 1.0)
        << kind.name << ": without the bend of the earth in its law the jet would rise by 1.4 m";
    EXPECT_NEAR(flown.Read().speed_m_per_s, CruiseSpeed(kind, 1000.0), 0.5) << kind.name;
    EXPECT_NEAR(Degrees(flown.Read().bank_rad), 0.0, 0.1) << kind.name;
    EXPECT_NEAR(flown.Read().load, 1.0, 0.005) << kind.name;
  }
}

TEST(Aircraft, LevelFlightFollowsTheCurvatureOfTheEarth) {
  // Eastwards from 46 N along a great circle: the sine rule says how far south it comes.
  Flown flown(3000.0, kSmallJet, 0.5 * kPi);
  const Place start = flown.Here();
  flown.Fly(600.0);
  const double along = 600.0 * CruiseSpeed(kSmallJet, 3000.0) /
                       (OsculatingRadius(kWgs84, start.latitude_rad()) + 3000.0);
  const double latitude = std::asin(std::sin(start.latitude_rad()) * std::cos(along));
  EXPECT_NEAR(Degrees(flown.Here().latitude_rad() - start.latitude_rad()),
              Degrees(latitude - start.latitude_rad()), 0.002)
      << "the ellipsoid differs from a sphere by 1/300 of 0.5 degrees";
  EXPECT_GT(flown.Read().heading_rad, 0.5 * kPi) << "north has turned under it";
}

// Hard case 27.
TEST(Aircraft, FliesStraightOverThePoleAndTheDateLine) {
  Flown flown(1000.0);
  flown.state = LevelFlight(kLightAircraft, kWgs84, Place{89.99, 20.0, 1000.0}, 0.0);
  flown.Fly(60.0);
  EXPECT_NEAR(Degrees(flown.Here().longitude_rad()), -160.0, 0.5) << "beyond the pole";
  EXPECT_NEAR(std::abs(Degrees(flown.Read().heading_rad)), 180.0, 0.5) << "southwards";
  EXPECT_NEAR(flown.Here().height_m, 1000.0, 1.0);
  flown.state = LevelFlight(kLightAircraft, kWgs84, Place{0.0, 179.999, 1000.0}, 0.5 * kPi);
  flown.Fly(60.0);
  EXPECT_LT(flown.Here().longitude_rad(), 0.0);
  EXPECT_NEAR(Degrees(flown.Read().heading_rad), 90.0, 0.01);
  // At the pole itself there is no heading that could be wrong, but all numbers are there.
  flown.state = LevelFlight(kLightAircraft, kWgs84, Place{90.0, 0.0, 1000.0}, 1.0);
  flown.Fly(1.0, {.roll_right = 1.0});
  EXPECT_TRUE(std::isfinite(flown.Read().heading_rad));
  EXPECT_NEAR(flown.Here().height_m, 1000.0, 1.0);
}

TEST(Aircraft, RadiusOfATurnFollowsFromSpeedAndBank) {
  Flown flown;
  while (flown.Read().bank_rad < 30.0 * kRadiansPerDegree) flown.Fly(kStep_s, {.roll_right = 0.5});
  flown.Fly(5.0);
  const AircraftReadout before = flown.Read();
  EXPECT_NEAR(Degrees(before.bank_rad), 30.0, 0.5) << "as when it was let go";
  flown.Fly(1.0);
  const AircraftReadout after = flown.Read();
  const double rate = std::remainder(after.heading_rad - before.heading_rad, 2.0 * kPi);
  const double speed = 0.5 * (before.speed_m_per_s + after.speed_m_per_s);
  const double bank = 0.5 * (before.bank_rad + after.bank_rad);
  const double radius = speed / rate;
  EXPECT_NEAR(radius / (speed * speed / (kG * std::tan(bank))), 1.0, 0.01)
      << "gravity at 1 km is 3e-4 weaker, speed falls by 1 % in the turn";
  EXPECT_NEAR(after.load * std::cos(after.bank_rad), 1.0, 0.01) << "wings carry the weight";
  EXPECT_NEAR(flown.Here().height_m, 1000.0, 15.0) << "and the height is kept";
}

TEST(Aircraft, ReleasedStickKeepsBankLevelsSmallAndLimitsLargeBank) {
  Flown small;
  small.Fly(0.2, {.roll_right = 0.2});
  small.Fly(6.0);
  EXPECT_NEAR(Degrees(small.Read().bank_rad), 0.0, 0.5);
  Flown steep;
  steep.Fly(1.2, {.roll_right = -1.0});
  EXPECT_LT(Degrees(steep.Read().bank_rad), -60.0);
  steep.Fly(6.0);
  EXPECT_NEAR(Degrees(steep.Read().bank_rad), -45.0, 1.0);
}

TEST(Aircraft, WingsCarryTheWeightDownToTheStallSpeed) {
  const double stall = StallSpeed(kLightAircraft, 1000.0);
  const double q = 0.5 * StandardAirAt(1000.0).density_kg_per_m3 * stall * stall;
  EXPECT_NEAR(q * kLightAircraft.wing_area_m2 * kLightAircraft.most_lift,
              kLightAircraft.mass_kg * kG, 1e-6);
  Flown flown;
  flown.state.throttle = 0.0;
  // Held level by the stick until the wings give up.
  while (flown.Read().path_rad > -0.02) {
    flown.Fly(kStep_s, {.pitch_up = flown.Read().path_rad < 0.0 ? 0.025 : -0.025});
  }
  EXPECT_NEAR(flown.Read().speed_m_per_s, stall, 0.05 * stall)
      << "the path has bent down by a degree since";
  EXPECT_TRUE(flown.Read().stalled);
  EXPECT_LT(flown.Here().height_m, 1000.0);
}

TEST(Aircraft, WithoutPowerGlidesAtTheAngleOfDragOverLift) {
  Flown flown(3000.0);
  flown.state.throttle = 0.0;
  flown.Fly(180.0);
  const AircraftReadout glide = flown.Read();
  const double q = 0.5 * StandardAirAt(flown.Here().height_m).density_kg_per_m3 *
                   glide.speed_m_per_s * glide.speed_m_per_s;
  const double lift = glide.load * kLightAircraft.mass_kg * kG / (q * kLightAircraft.wing_area_m2);
  const double drag = kLightAircraft.zero_lift_drag + kLightAircraft.induced_drag * lift * lift;
  EXPECT_NEAR(std::tan(-glide.path_rad), drag / lift, 0.005) << "a steady glide";
  EXPECT_GT(glide.indicated_m_per_s, 1.15 * StallSpeed(kLightAircraft, 0.0)) << "not stalled";
  EXPECT_FALSE(glide.stalled);
  // The best glide of a parabolic polar is 1 / (2 sqrt(k C_D0)) = 12.2.
  EXPECT_GT(1.0 / std::tan(-glide.path_rad), 8.0);
  EXPECT_LT(1.0 / std::tan(-glide.path_rad), 12.3);
}

TEST(Aircraft, ClimbRateFollowsFromExcessThrust) {
  Flown flown(500.0);
  flown.Fly(2.0, {.throttle_up = 1.0});
  flown.state.held_path_rad = 3.0 * kRadiansPerDegree;
  flown.Fly(120.0);
  const AircraftReadout climb = flown.Read();
  const StandardAir air = StandardAirAt(flown.Here().height_m);
  const double v = climb.speed_m_per_s;
  const double q_area = 0.5 * air.density_kg_per_m3 * v * v * kLightAircraft.wing_area_m2;
  const double weight = kLightAircraft.mass_kg * kG;
  const double lift = climb.load * weight / q_area;
  const double drag_N =
      q_area * (kLightAircraft.zero_lift_drag + kLightAircraft.induced_drag * lift * lift);
  const double power = kLightAircraft.power_W * (1.1325 * air.density_kg_per_m3 / 1.225 - 0.1325);
  EXPECT_NEAR(climb.vertical_speed_m_per_s, (power - drag_N * v) / weight, 0.15)
      << "climb = (power - drag x speed) / weight, once the speed is steady";
  EXPECT_NEAR(Degrees(climb.path_rad), 3.0, 0.1);
}

TEST(Aircraft, LeavesAClimbTooSteepForTheEngineWithoutOscillating) {
  for (const double pull_s : {0.5, 1.0, 2.0, 4.0}) {
    Flown flown(1500.0);
    flown.Fly(pull_s, {.pitch_up = 1.0, .throttle_up = 1.0});
    flown.Fly(60.0);
    double least = 1e9, most = -1e9;
    for (int second = 0; second < 60; ++second) {
      flown.Fly(1.0);
      least = std::min(least, flown.Read().path_rad);
      most = std::max(most, flown.Read().path_rad);
      EXPECT_GT(flown.Read().speed_m_per_s,
                1.15 * StallSpeed(kLightAircraft, flown.Here().height_m));
    }
    EXPECT_LT(Degrees(most - least), 2.0) << pull_s << " s of pulling: the path is steady";
    EXPECT_GT(Degrees(least), -2.0) << pull_s;
    EXPECT_LT(Degrees(most), 10.0) << pull_s << ": 5 m/s of climb at 33 m/s are 9 degrees";
  }
}

TEST(Aircraft, EnergyIsConservedWithoutDragAndThrust) {
  Flown flown(4000.0);
  flown.kind.zero_lift_drag = 0.0;
  flown.kind.induced_drag = 0.0;
  flown.state.throttle = 0.0;
  const auto energy = [&] {
    const double h = flown.Here().height_m;
    const double r = OsculatingRadius(kWgs84, flown.Here().latitude_rad());
    return 0.5 * std::pow(flown.Read().speed_m_per_s, 2) + kG * h * r / (r + h);
  };
  const double before = energy();
  flown.Fly(5.0, {.pitch_up = -0.4});
  flown.Fly(4.0, {.pitch_up = 0.5, .roll_right = 0.2});
  flown.Fly(10.0);
  EXPECT_NEAR(energy() / before, 1.0, 2e-4)
      << "lift does no work: midpoint steps of 1/120 s, g of the osculating sphere";
}

TEST(Aircraft, PowerFallsInThinAirAndLimitsTheHeight) {
  Flown low(500.0), high(7500.0);
  for (Flown* flown : {&low, &high}) {
    flown->state.throttle = 1.0;
    flown->state.held_path_rad = 2.0 * kRadiansPerDegree;
    flown->Fly(180.0);
  }
  EXPECT_GT(low.Read().vertical_speed_m_per_s, 1.0);
  EXPECT_LT(high.Read().vertical_speed_m_per_s, 0.0) << "over its ceiling it sinks";
  EXPECT_FALSE(high.Read().stalled);
}

TEST(Aircraft, LoadFactorStaysWithinItsLimitsForAnyStick) {
  for (const double pull : {1.0, -1.0}) {
    Flown flown(3000.0);
    flown.state.velocity.xyz *= 1.5;
    for (int i = 0; i < 10 * 120; ++i) {
      flown.Fly(kStep_s, {.pitch_up = pull, .roll_right = 0.3});
      ASSERT_LE(flown.Read().load, kLightAircraft.most_load + 1e-9);
      ASSERT_GE(flown.Read().load, kLightAircraft.least_load - 1e-9);
    }
  }
}

TEST(Aircraft, CanFlyALoop) {
  Flown flown(1000.0);
  flown.state.velocity.xyz *= 1.5;
  bool was_inverted = false;
  for (int i = 0; i < 60 * 120 && !(was_inverted && flown.Read().path_rad > -0.05 &&
                                    std::abs(flown.Read().bank_rad) < 0.5);
       ++i) {
    flown.Fly(kStep_s, {.pitch_up = 1.0, .throttle_up = 1.0});
    was_inverted |= std::abs(flown.Read().bank_rad) > 2.5;
    ASSERT_NEAR(glm::length(flown.state.ahead.xyz), 1.0, 1e-9);
    ASSERT_NEAR(glm::dot(flown.state.ahead.xyz, flown.state.up.xyz), 0.0, 1e-9);
  }
  EXPECT_TRUE(was_inverted);
  EXPECT_NEAR(Degrees(flown.Read().bank_rad), 0.0, 5.0) << "wings are where they were";
  EXPECT_NEAR(Degrees(flown.Read().heading_rad), 0.0, 2.0);
}

TEST(Aircraft, RudderTurnsSlightlyWithoutBank) {
  Flown flown;
  flown.Fly(10.0, {.yaw_right = 1.0});
  EXPECT_GT(Degrees(flown.Read().heading_rad), 3.0);
  EXPECT_LT(Degrees(flown.Read().heading_rad), 30.0);
  EXPECT_NEAR(Degrees(flown.Read().bank_rad), 0.0, 1.0);
}

TEST(Aircraft, LandsRollsAndStopsWithBrakes) {
  Flown flown(30.0);
  flown.ground = SeaLevel;
  flown.state.throttle = 0.13;  // a path of 3 degrees at 1.3 times the stall speed
  flown.state.velocity.xyz *= 0.6;
  flown.state.held_path_rad = -3.0 * kRadiansPerDegree;
  bool rolled = false;
  for (int i = 0; i < 60 * 120; ++i) {
    flown.Fly(kStep_s, rolled ? Stick{.throttle_up = -1.0, .brake = 1.0} : Stick{});
    rolled |= flown.Read().contact == GroundContact::kRolling;
    ASSERT_NE(flown.Read().contact, GroundContact::kScraping);
    ASSERT_GE(flown.Here().height_m, 1.49);
  }
  EXPECT_TRUE(rolled);
  EXPECT_EQ(flown.Read().contact, GroundContact::kStanding);
  EXPECT_EQ(flown.Read().speed_m_per_s, 0.0);
}

TEST(Aircraft, TakesOffAgainWithFullThrottle) {
  Flown flown(1.0);
  flown.ground = SeaLevel;
  flown.state.velocity.xyz *= 0.0;
  flown.state.throttle = 0.0;
  flown.Fly(2.0);
  EXPECT_EQ(flown.Read().contact, GroundContact::kStanding);
  flown.Fly(40.0, {.throttle_up = 1.0});
  flown.Fly(20.0, {.pitch_up = 0.08});
  EXPECT_EQ(flown.Read().contact, GroundContact::kNone);
  EXPECT_GT(flown.Here().height_m, 20.0);
}

TEST(Aircraft, IsStoppedByAMountainAndNeverEntersTheGround) {
  // A wall of 45 degrees to the north of the start.
  const double foot = 46.02 * kRadiansPerDegree;
  const GroundHeight wall = [&](const Place& place) {
    return std::max(0.0, (place.latitude_rad() - foot) * 6.37e6);
  };
  for (const double height_m : {50.0, 1000.0}) {
    Flown flown(height_m);
    flown.ground = wall;
    bool scraped = false;
    for (int i = 0; i < 200 * 120; ++i) {
      flown.Fly(kStep_s);
      scraped |= flown.Read().contact == GroundContact::kScraping;
      ASSERT_GE(flown.Here().height_m, wall(flown.Here()) + 1.49);
      ASSERT_LT(flown.Read().speed_m_per_s, 90.0) << "the wall gives no energy";
    }
    EXPECT_TRUE(scraped);
  }
}

TEST(Aircraft, FallsInThinAirUntilTheAirCarriesIt) {
  Flown flown(18000.0, kSmallJet);
  flown.state.velocity.xyz *= 0.01;
  flown.Fly(240.0);
  EXPECT_FALSE(flown.Read().stalled);
  EXPECT_GT(flown.Here().height_m, 2000.0) << "it has caught itself";
  EXPECT_NEAR(flown.Read().load, 1.0, 0.5);
}

TEST(Aircraft, ViewFollowsNoseAndBank) {
  Flown flown(1000.0, kLightAircraft, 1.2);
  CameraPose eye = EyeIn(flown.state, flown.kind, kWgs84, 0.0, 0.0, 1.0);
  EXPECT_NEAR(eye.heading_rad, 1.2, 1e-9);
  EXPECT_NEAR(Degrees(eye.pitch_rad), 0.0, 0.1) << "cruising, the nose points along the path";
  EXPECT_NEAR(eye.roll_rad, 0.0, 1e-9);
  EXPECT_EQ(eye.fov_rad, 1.0);
  flown.Fly(1.0, {.roll_right = 0.5});
  eye = EyeIn(flown.state, flown.kind, kWgs84, 0.0, 0.0, 1.0);
  EXPECT_NEAR(eye.roll_rad, flown.Read().bank_rad, 0.02);
  const CameraPose aside = EyeIn(flown.state, flown.kind, kWgs84, 0.5 * kPi, 0.0, 1.0);
  EXPECT_NEAR(aside.pitch_rad, -flown.Read().bank_rad, 0.02) << "the right wing points down";
}

// --- the autopilot ---

constexpr double kPilotStep_s = 1.0 / 120.0;

/// An aircraft with its autopilot, far over the ground.
struct Held {
  AircraftKind kind;
  AircraftState state;
  Autopilot autopilot;

  Held(const AircraftKind& of, double height_m)
      : kind(of), state(LevelFlight(of, kWgs84, CheckedPlace({46.0, 8.0, height_m}), 0.0)) {}

  void Step(const Stick& hands = {}) {
    const Autopilot::Flown flown = autopilot.Fly(state, kind, kWgs84, hands, kPilotStep_s);
    state = Stepped(
        flown.state, kind, kWgs84, flown.stick, [](const Place&) { return -1e5; }, kPilotStep_s);
  }
  template <typename Visit>
  void Fly(double seconds, const Visit& visit) {
    for (double t = 0.0; t < seconds; t += kPilotStep_s) {
      Step();
      visit(t);
    }
  }
  [[nodiscard]] AircraftReadout Read() const { return ReadoutOf(state, kind, kWgs84); }
  [[nodiscard]] double Height() const { return GeodeticFromEcef(kWgs84, state.place).height_m; }
};

double Apart(double heading_rad, double other_rad) {
  return std::remainder(heading_rad - other_rad, 2.0 * kPi);
}

TEST(Autopilot, TurnsTheShortWayAndOvershootsByAtMostTwoDegrees) {
  for (const AircraftKind& kind : {kLightAircraft, kSmallJet}) {
    for (const double target :
         {90.0 * kRadiansPerDegree, -135.0 * kRadiansPerDegree, 10.0 * kRadiansPerDegree}) {
      Held held(kind, 1500.0);
      held.autopilot.Set({.heading_rad = target});
      double over = 0.0, steepest = 0.0;
      held.Fly(150.0, [&](double) {
        const double apart = Apart(held.Read().heading_rad, target);
        over = std::max(over, target > 0.0 ? apart : -apart);
        steepest = std::max(steepest, std::abs(held.Read().bank_rad));
      });
      EXPECT_LT(over, 2.0 * kRadiansPerDegree) << kind.name << " to " << target / kRadiansPerDegree;
      EXPECT_NEAR(Apart(held.Read().heading_rad, target) / kRadiansPerDegree, 0.0, 0.1)
          << kind.name;
      EXPECT_LT(steepest, 26.0 * kRadiansPerDegree) << kind.name;
      EXPECT_NEAR(held.Height(), 1500.0, 20.0) << kind.name;
    }
  }
}

TEST(Autopilot, ReachesAHeightWithAtMostFiveMetresOfOvershoot) {
  for (const AircraftKind& kind : {kLightAircraft, kSmallJet}) {
    for (const double change_m : {300.0, -300.0, 30.0}) {
      Held held(kind, 1000.0);
      held.autopilot.Set(
          {.height_m = 1000.0 + change_m, .speed_m_per_s = 0.85 * held.Read().speed_m_per_s});
      double over = 0.0;
      held.Fly(180.0, [&](double) {
        const double apart = held.Height() - (1000.0 + change_m);
        over = std::max(over, change_m > 0.0 ? apart : -apart);
      });
      EXPECT_LT(over, 5.0) << kind.name << " by " << change_m << " m";
      EXPECT_NEAR(held.Height(), 1000.0 + change_m, 1.0) << kind.name;
    }
  }
}

TEST(Autopilot, ReachesASpeedWithAtMostOneMetrePerSecondOfOvershoot) {
  for (const AircraftKind& kind : {kLightAircraft, kSmallJet}) {
    for (const double factor : {0.8, 0.95}) {
      Held held(kind, 1000.0);
      const double target = factor * held.Read().speed_m_per_s;
      held.autopilot.Set({.height_m = 1000.0, .speed_m_per_s = target});
      double least = 1e9;
      held.Fly(240.0, [&](double) { least = std::min(least, held.Read().speed_m_per_s); });
      EXPECT_GT(least, target - 1.0) << kind.name;
      EXPECT_NEAR(held.Read().speed_m_per_s, target, 0.2) << kind.name;
      EXPECT_NEAR(held.Height(), 1000.0, 2.0) << kind.name;
    }
  }
}

TEST(Autopilot, HoldsAClimb) {
  Held held(kSmallJet, 1000.0);
  held.autopilot.Set({.climb_m_per_s = 5.0, .speed_m_per_s = held.Read().speed_m_per_s});
  held.Fly(60.0, [](double) {});
  EXPECT_NEAR(held.Read().vertical_speed_m_per_s, 5.0, 0.1);
}

TEST(Autopilot, EngagesInATurnWithoutAJerk) {
  Held held(kLightAircraft, 1500.0);
  for (int i = 0; i < 120; ++i) held.Step({.roll_right = 0.5});
  held.autopilot.Toggle(Autopilot::Hold::kHeading, held.Read(), held.Height());
  held.autopilot.Toggle(Autopilot::Hold::kHeight, held.Read(), held.Height());
  AircraftReadout before = held.Read();
  held.Fly(20.0, [&](double t) {
    const AircraftReadout now = held.Read();
    if (t > 0.5) {
      EXPECT_LT(std::abs(now.bank_rad - before.bank_rad) / kPilotStep_s, 12.0 * kRadiansPerDegree)
          << "8 degrees a second are asked for";
    }
    EXPECT_LT(std::abs(now.load - before.load) / kPilotStep_s, 2.0) << "loads a second";
    before = now;
  });
}

TEST(Autopilot, ControlsChangeTheHeldValues) {
  Held held(kLightAircraft, 1500.0);
  held.autopilot.Set({.heading_rad = 0.0, .height_m = 1500.0, .speed_m_per_s = 50.0});
  for (int i = 0; i < 120; ++i)
    held.Step({.pitch_up = 1.0, .roll_right = -1.0, .throttle_up = -1.0});
  EXPECT_NEAR(*held.autopilot.targets().heading_rad, -10.0 * kRadiansPerDegree, 1e-9);
  EXPECT_NEAR(*held.autopilot.targets().height_m, 1520.0, 1e-9);
  EXPECT_NEAR(*held.autopilot.targets().speed_m_per_s, 45.0, 1e-9);
  EXPECT_LT(std::abs(held.Read().bank_rad), 10.0 * kRadiansPerDegree)
      << "the stick itself flies nothing";
}

TEST(Autopilot, ExclusiveHoldsReplaceEachOther) {
  Held held(kLightAircraft, 1500.0);
  const auto toggle = [&](Autopilot::Hold hold) {
    held.autopilot.Toggle(hold, held.Read(), held.Height());
  };
  toggle(Autopilot::Hold::kHeading);
  toggle(Autopilot::Hold::kLevelWings);
  EXPECT_FALSE(held.autopilot.targets().heading_rad);
  toggle(Autopilot::Hold::kHeight);
  EXPECT_EQ(TextOf(held.autopilot.targets()), "LVL ALT 1500 m");
  toggle(Autopilot::Hold::kClimb);
  EXPECT_EQ(TextOf(held.autopilot.targets()), "LVL V/S +0.0 m/s");
  toggle(Autopilot::Hold::kClimb);
  toggle(Autopilot::Hold::kLevelWings);
  EXPECT_FALSE(held.autopilot.targets().HoldsAnything());
  EXPECT_EQ(TextOf({.heading_rad = -0.5 * kPi, .speed_m_per_s = 61.2}), "HDG 270 SPD 61 m/s");
}

TEST(Autopilot, DoesNotStallForAnUnreachableHeight) {
  Held held(kLightAircraft, 5000.0);
  held.autopilot.Set({.height_m = 9000.0});
  held.Fly(600.0, [](double) {});
  EXPECT_FALSE(held.Read().stalled);
  EXPECT_GT(held.Read().speed_m_per_s, 1.1 * StallSpeed(kLightAircraft, held.Height()));
}

}  // namespace
}  // namespace alpenglow::viewer
