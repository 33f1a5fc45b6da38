// SPDX-License-Identifier: MIT
// Tabulated bent rays against the ray equation.
#include "renderer/surface/scene_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"

namespace alpenglow::renderer {
namespace {

constexpr double kMinute = kRadiansPerDegree / 60.0;
const glm::dvec3 kUp(0.0, 0.0, 1.0);

TEST(RefractedFan, PlacesOnRaysAreThoseOfTheEquationAtEveryHeight) {
  const Medium medium = MediumPreset("earth");
  const double radius_m = medium.planet_radius_m;
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  const BendingAir air = BendingAirOf(medium, kHorizonWavelength_nm);
  for (const double height_m : {2.0, 1000.0, 3000.0, 12e3, 110e3, 400e3}) {
    const glm::dvec3 eye(0.0, 0.0, height_m);
    const double horizon_m = std::sqrt(height_m * (2.0 * radius_m + height_m));
    const double reach_m = horizon_m + 400e3;
    const RefractedFan fan(air, eye, kUp, reach_m);
    const double horizon_rad = RefractedView(medium, height_m).horizon_rad();
    for (const double over_minutes : {0.1, 5.0, 30.0, 300.0}) {
      const double elevation = horizon_rad + over_minutes * kMinute;
      const glm::dvec3 towards(0.0, std::cos(elevation), std::sin(elevation));
      const FanRay ray(fan, eye, towards);
      double farthest_off = 0.0;
      for (int i = 1; i <= 40; ++i) {
        const double length_m = std::max(height_m < 100e3 ? 0.0 : horizon_m - 400e3, 0.0) +
                                (height_m < 100e3 ? reach_m : 700e3) * i / 41.0;
        const auto truth = equation.Follow(elevation, height_m, length_m).state;
        const glm::dvec3 place(0.0, truth.x, truth.y - radius_m);
        const double along_m = glm::dot(place - eye, towards);
        farthest_off = std::max(farthest_off, glm::length(ray.At(along_m) - place) / along_m);
      }
      EXPECT_LT(farthest_off / kMinute, 0.1)
          << "a tenth of an arcminute seen from the eye at " << height_m << " m, " << over_minutes
          << "' over the horizon";
    }
  }
}

TEST(RefractedFan, WithoutAirARayIsStraight) {
  BendingAir air = BendingAirOf(MediumPreset("earth"), kHorizonWavelength_nm);
  air.refractivity = 0.0;
  const glm::dvec3 eye(0.0, 0.0, 1000.0);
  const RefractedFan fan(air, eye, kUp, 100e3);
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 0.9, -0.02));
  EXPECT_LT(glm::length(FanRay(fan, eye, towards).At(90e3) - eye - 90e3 * towards), 1e-6)
      << "the rounding of places of 90 km";
}

TEST(RefractedFan, ChordsAreNotAboveTheirRayAndNoFartherOffThanAskedFor) {
  const BendingAir air = BendingAirOf(MediumPreset("earth"), kHorizonWavelength_nm);
  const glm::dvec3 eye(0.0, 0.0, 500.0);
  const RefractedFan fan(air, eye, kUp, 200e3);
  constexpr double kOff_rad = 0.1 * kMinute;
  for (const double elevation : {-0.01, -0.005, 0.0, 0.01, 0.1}) {
    const FanRay ray(fan, eye, {0.0, std::cos(elevation), std::sin(elevation)});
    const auto over_chord = [&](double from_m, double to_m, double share) {
      const glm::dvec3 chord = (1.0 - share) * ray.At(from_m) + share * ray.At(to_m);
      return (ray.At(from_m + share * (to_m - from_m)) - chord).z;
    };
    for (const double from_m : {0.0, 10e3, 50e3}) {
      const double to_m = from_m + fan.ChordFrom(from_m, kOff_rad);
      for (const double share : {0.1, 0.5, 0.9}) {
        const double over_m = over_chord(from_m, to_m, share);
        EXPECT_GT(over_m, -1e-3) << "tables are linear between their nodes";
        EXPECT_LT(over_m, kOff_rad * (from_m + share * (to_m - from_m)) + kOff_rad * 1e3)
            << "from " << from_m << " m, elevation " << elevation;
      }
      const double before_end_m = 150e3 - fan.EndOfChord(kOff_rad);
      EXPECT_LT(over_chord(0.0, 150e3, before_end_m / 150e3), kOff_rad * before_end_m)
          << "the end of a long one";
    }
  }
}

TEST(RefractedFan, RaysAreBelowAndAboveTheHeightsThatTheyAreSaidToBe) {
  const BendingAir air = BendingAirOf(MediumPreset("earth"), kHorizonWavelength_nm);
  const glm::dvec3 eye(0.0, 0.0, 1400.0);
  const RefractedFan fan(air, eye, kUp, 200e3);
  const auto height_at = [&](const FanRay& ray, double along_m) {
    return glm::length(ray.At(along_m) + glm::dvec3(0.0, 0.0, air.planet_radius_m)) -
           air.planet_radius_m;
  };
  for (const double elevation : {-1.5, -0.3, -0.05, -0.02}) {
    const FanRay ray(fan, eye, {std::cos(elevation), 0.0, std::sin(elevation)});
    EXPECT_LT(height_at(ray, fan.SinksBelow(ray, 200.0)), 200.0) << elevation;
  }
  const FanRay over_ground(fan, eye, {std::cos(-0.001), 0.0, std::sin(-0.001)});
  EXPECT_TRUE(std::isinf(fan.SinksBelow(over_ground, 200.0))) << "it passes over the horizon";
  for (const double elevation : {0.01, 0.1, 1.0}) {
    const FanRay ray(fan, eye, {std::cos(elevation), 0.0, std::sin(elevation)});
    const double along_m = fan.RisesAbove(ray, 1600.0);
    EXPECT_GE(height_at(ray, along_m), 1600.0) << elevation;
    EXPECT_GT(height_at(ray, 1.5 * along_m), height_at(ray, along_m)) << elevation;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
