// SPDX-License-Identifier: MIT
// Land and the edge of a planet as shaders lift them, against the ray equation.
#include "atmosphere/refraction/refracted_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/ray/shell.h"
#include "atmosphere/reference/reference_solution.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kMinuteOfArc = kRadiansPerDegree / 60.0;

struct LandSight {
  double distance_m, place_m, lift_rad;
};

/// Where a ray of the equation is after a way, seen from the eye.
LandSight SightAlong(const Medium& medium, double elevation_rad, double eye_m, double way_m) {
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  const auto end = equation.Follow(elevation_rad, eye_m, way_m);
  const double up_m = end.state.y - medium.planet_radius_m - eye_m;
  return {std::hypot(end.state.x, up_m),
          std::hypot(end.state.x, end.state.y) - medium.planet_radius_m,
          elevation_rad - std::atan2(up_m, end.state.x)};
}

TEST(LandLift, IsThatOfTheRayEquationFromEveryHeight) {
  const Medium medium = MediumPreset("earth");
  constexpr double kHighestLand_m = 9000.0;
  for (const double eye_m : {2.0, 100.0, 1e3, 3e3, 8e3, 12e3, 16e3, 25e3, 40e3, 100e3, 400e3}) {
    const BendingAir air = GentleAirOf(medium);
    const LandBend bend = LandBendOf(air, eye_m);
    const double horizon_m = std::sqrt(eye_m * (eye_m + 2.0 * medium.planet_radius_m));
    int seen = 0;
    for (const double over_minutes : {0.1, 2.0, 10.0, 40.0}) {
      const double elevation = GrazingElevation(air, eye_m) + over_minutes * kMinuteOfArc;
      for (double way_m = 20e3; way_m < horizon_m + 350e3; way_m += std::max(20e3, 0.05 * way_m)) {
        const LandSight sight = SightAlong(medium, elevation, eye_m, way_m);
        if (sight.place_m > kHighestLand_m || sight.place_m < 0.0) continue;
        ++seen;
        EXPECT_NEAR(LiftOfLand(bend, eye_m, sight.place_m, sight.distance_m) / kMinuteOfArc,
                    sight.lift_rad / kMinuteOfArc, eye_m <= 16e3 ? 0.3 : 0.5)
            << "the bounds of LiftOfLand; eye " << eye_m << " m, " << over_minutes
            << "' over the horizon, " << sight.place_m << " m high, " << sight.distance_m
            << " m away";
      }
    }
    EXPECT_GT(seen, 3) << eye_m;
  }
}

TEST(LandLift, AMountainAHundredKilometresAwayLooksFourMinutesHigher) {
  const LandBend bend = LandBendOf(GentleAirOf(MediumPreset("earth")), 500.0);
  EXPECT_NEAR(LiftOfLand(bend, 500.0, 4000.0, 100e3) / kMinuteOfArc, 4.2, 0.3)
      << "half of 100 km times the curvature, a sixth of the earth's";
}

TEST(LandLift, OfAPlanetIsAtLeastThatOfItsLandAndItsHorizon) {
  const Medium medium = MediumPreset("earth");
  const BendingAir air = GentleAirOf(medium);
  for (const double eye_m : {2.0, 1e3, 12e3, 400e3}) {
    const LandBend bend = LandBendOf(air, eye_m);
    const double geometric_rad =
        -std::acos(medium.planet_radius_m / (medium.planet_radius_m + eye_m));
    constexpr double kFarthest_m = 60e3;
    const double most_rad = MostLiftOfPlanet(bend, eye_m, kFarthest_m);
    EXPECT_GT(most_rad, GrazingElevation(air, eye_m) - geometric_rad - 0.01 * kMinuteOfArc)
        << eye_m;
    for (const double place_m : {0.0, 1e3, 3e3})
      EXPECT_GE(most_rad, LiftOfLand(bend, eye_m, place_m, 30e3)) << eye_m << ", " << place_m;
  }
  const double half_curved_rad = -0.5 * 60e3 * CurvaturePerMetreAt(air, 0.0);
  EXPECT_NEAR(MostLiftOfPlanet(LandBendOf(air, 2.0), 2.0, 60e3) / half_curved_rad, 1.0, 0.05)
      << "half of 60 km times the curvature at the ground, which the horizon 5 km away does not "
         "reach";
}

TEST(LandLift, NothingIsLiftedWithoutAir) {
  BendingAir air = GentleAirOf(MediumPreset("earth"));
  air.refractivity = 0.0;
  const LandBend bend = LandBendOf(air, 3000.0);
  EXPECT_EQ(LiftOfLand(bend, 3000.0, 1000.0, 150e3), 0.0);
  EXPECT_NEAR(MostLiftOfPlanet(bend, 3000.0, 150e3), 0.0, 1e-9);
  EXPECT_NEAR(bend.look_radius_km, bend.radius_km, 1e-3) << "a metre";
}

TEST(LandLift, ThePlanetLooksAsWideAsRefractedRaysShowItsHorizon) {
  const Medium medium = MediumPreset("earth");
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  for (const double eye_m : {2.0, 100.0, 3e3, 12e3, 400e3}) {
    const LandBend bend = LandBendOf(GentleAirOf(medium), eye_m);
    const double horizon_rad =
        std::asin(shared::HorizonCosine(eye_m / kMetresPerKilometre, bend.look_radius_km));
    constexpr double kLittle = 0.02 * kMinuteOfArc;
    EXPECT_FALSE(equation.Follow(horizon_rad + kLittle, eye_m).is_ground) << eye_m;
    EXPECT_TRUE(equation.Follow(horizon_rad - kLittle, eye_m).is_ground) << eye_m;
    // Ground half way to the horizon, along a straight line to the planet as it looks.
    const double elevation = 1.3 * horizon_rad;
    const auto found = equation.Follow(elevation, eye_m);
    const double away_m = std::hypot(found.state.x, found.state.y - medium.planet_radius_m - eye_m);
    EXPECT_NEAR(shared::DistanceDownTo(eye_m / kMetresPerKilometre, std::sin(elevation), 0.0,
                                       bend.look_radius_km) *
                    kMetresPerKilometre / away_m,
                1.0, 0.03)
        << eye_m;
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
