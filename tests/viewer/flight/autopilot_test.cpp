// SPDX-License-Identifier: MIT
#include "viewer/flight/pilot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

constexpr double kPilotStep_s = 1.0 / 120.0;
constexpr double kDegree = kRadiansPerDegree;

/// An aircraft with its autopilot, far over the ground.
struct Held {
  AircraftKind kind;
  AircraftState state;
  Autopilot autopilot;

  Held(const AircraftKind& of, double height_m)
      : kind(of), state(LevelFlight(of, kWgs84, PlaceFromDegrees(46.0, 8.0, height_m), 0.0)) {}

  void Step(const Stick& hands = {}) {
    const Autopilot::Flown flown = autopilot.Fly(state, kind, kWgs84, hands, kPilotStep_s);
    state = Stepped(
        flown.state, kind, kWgs84, flown.stick, [](const GeodeticPosition&) { return -1e5; },
        kPilotStep_s);
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

TEST(Autopilot, ANewHeadingIsReachedTheShortWayWithoutOvershootBeyondTwoDegrees) {
  for (const AircraftKind& kind : {kLightAircraft, kSmallJet}) {
    for (const double target : {90.0 * kDegree, -135.0 * kDegree, 10.0 * kDegree}) {
      Held held(kind, 1500.0);
      held.autopilot.Set({.heading_rad = target});
      double over = 0.0, steepest = 0.0;
      held.Fly(150.0, [&](double) {
        const double apart = Apart(held.Read().heading_rad, target);
        over = std::max(over, target > 0.0 ? apart : -apart);
        steepest = std::max(steepest, std::abs(held.Read().bank_rad));
      });
      EXPECT_LT(over, 2.0 * kDegree) << kind.name << " to " << target / kDegree;
      EXPECT_NEAR(Apart(held.Read().heading_rad, target) / kDegree, 0.0, 0.1) << kind.name;
      EXPECT_LT(steepest, 26.0 * kDegree) << kind.name;
      EXPECT_NEAR(held.Height(), 1500.0, 20.0) << kind.name;
    }
  }
}

TEST(Autopilot, ANewHeightIsReachedWithoutOvershootBeyondFiveMetres) {
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

TEST(Autopilot, ANewSpeedIsReachedWithoutOvershootBeyondAMetreASecond) {
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

TEST(Autopilot, AClimbIsHeld) {
  Held held(kSmallJet, 1000.0);
  held.autopilot.Set({.climb_m_per_s = 5.0, .speed_m_per_s = held.Read().speed_m_per_s});
  held.Fly(60.0, [](double) {});
  EXPECT_NEAR(held.Read().vertical_speed_m_per_s, 5.0, 0.1);
}

TEST(Autopilot, EngagedInATurnItJerksNothing) {
  Held held(kLightAircraft, 1500.0);
  for (int i = 0; i < 120; ++i) held.Step({.roll_right = 0.5});
  held.autopilot.Toggle(Autopilot::Hold::kHeading, held.Read(), held.Height());
  held.autopilot.Toggle(Autopilot::Hold::kHeight, held.Read(), held.Height());
  AircraftReadout before = held.Read();
  held.Fly(20.0, [&](double t) {
    const AircraftReadout now = held.Read();
    if (t > 0.5) {
      EXPECT_LT(std::abs(now.bank_rad - before.bank_rad) / kPilotStep_s, 12.0 * kDegree)
          << "8 degrees a second are asked for";
    }
    EXPECT_LT(std::abs(now.load - before.load) / kPilotStep_s, 2.0) << "loads a second";
    before = now;
  });
}

TEST(Autopilot, HandsMoveWhatIsHeld) {
  Held held(kLightAircraft, 1500.0);
  held.autopilot.Set({.heading_rad = 0.0, .height_m = 1500.0, .speed_m_per_s = 50.0});
  for (int i = 0; i < 120; ++i)
    held.Step({.pitch_up = 1.0, .roll_right = -1.0, .throttle_up = -1.0});
  EXPECT_NEAR(*held.autopilot.targets().heading_rad, -10.0 * kDegree, 1e-9);
  EXPECT_NEAR(*held.autopilot.targets().height_m, 1520.0, 1e-9);
  EXPECT_NEAR(*held.autopilot.targets().speed_m_per_s, 45.0, 1e-9);
  EXPECT_LT(std::abs(held.Read().bank_rad), 10.0 * kDegree) << "the stick itself flies nothing";
}

TEST(Autopilot, WhatCannotBeTogetherReplacesEachOther) {
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

TEST(Autopilot, AHeightThatCannotBeReachedIsNoStall) {
  Held held(kLightAircraft, 5000.0);
  held.autopilot.Set({.height_m = 9000.0});
  held.Fly(600.0, [](double) {});
  EXPECT_FALSE(held.Read().stalled);
  EXPECT_GT(held.Read().speed_m_per_s, 1.1 * StallSpeed(kLightAircraft, held.Height()));
}

}  // namespace
}  // namespace alpenglow::viewer
