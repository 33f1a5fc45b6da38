// SPDX-License-Identifier: MIT
#include "renderer/specular/surface_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/material/reflectance.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

/// Returns the photons of a light in the zenith behind a sphere of radius 1 that stands on z = 0.
std::vector<PhotonBeam> OntoFloor(const SpecularSphere& sphere, int photons) {
  const auto to_floor = [](const glm::dvec3& origin, const glm::dvec3& direction) {
    return direction.z < 0.0 ? -origin.z / direction.z : std::numeric_limits<double>::infinity();
  };
  return FollowPhotons(std::vector{sphere}, {}, {.photons = photons, .longest_m = 1e3}, to_floor);
}

// 90 photons in the disk: a noise of 13 % for random ones, and less for those of a sequence.
TEST(SurfaceMap, LightThroughNothingIsThatBesideTheSphere) {
  const int photons = tests::ScaledDown(100000, 4000);
  const SpecularSphere air{{0.0, 0.0, 1.0}, 1.0, SphereMaterial::kGlass, 1.0};
  const SurfaceMap map(OntoFloor(air, photons), tests::ScaledDown(0.03, 0.15));
  for (const glm::dvec3& point : {glm::dvec3(0.0), {0.4, -0.3, 0.0}, {-0.6, 0.1, 0.0}})
    EXPECT_NEAR(map.Irradiance(point), 1.0, 0.13);
  EXPECT_EQ(map.Irradiance({1.3, 0.0, 0.0}), 0.0);
}

/// Returns the distance from the axis at which a ray that meets glass at the distance rho lands, by
/// Snell's law. The exit lies at the angle 2 inside - entry from the lowest point.
double LandsAt(double rho, double index) {
  const double entry = std::asin(rho), inside = std::asin(rho / index);
  const double away = 2.0 * inside - entry;
  return std::sin(away) - (1.0 - std::cos(away)) * std::tan(2.0 * (entry - inside));
}

/// Returns the irradiance of a ring of the floor: the power of all rays that land there.
double ByRings(double low, double high, double index) {
  constexpr int kRays = 200000;
  double power_m2 = 0.0;
  for (int i = 0; i < kRays; ++i) {
    const double rho = (i + 0.5) / kRays;
    const double at = std::abs(LandsAt(rho, index));
    if (at < low || at > high) continue;
    const double left = 1.0 - FresnelReflectance(std::sqrt(1.0 - rho * rho), index);
    power_m2 += 2.0 * kPi * rho / kRays * left * left;
  }
  return power_m2 / (kPi * (high * high - low * low));
}

// The spots of photons widen a ring by their radius, and light that is reflected inside is missing in
// the expected value: a few per cent.
TEST(SurfaceMap, GlassFocusesLightBySnellsLaw) {
  constexpr double kIndex = 1.5;
  const SpecularSphere glass{{0.0, 0.0, 1.0}, 1.0, SphereMaterial::kGlass, kIndex};
  const SurfaceMap map(OntoFloor(glass, tests::ScaledDown(200000, 20000)), 0.01);
  for (const auto& [low, high] : {std::pair{0.02, 0.06}, {0.06, 0.12}, {0.12, 0.16}}) {
    double sum = 0.0, weights = 0.0;
    for (double distance = low + 0.0025; distance < high; distance += 0.005) {
      for (int k = 0; k < 24; ++k) {
        const double azimuth = 2.0 * kPi * k / 24;
        sum += distance *
               map.Irradiance({distance * std::cos(azimuth), distance * std::sin(azimuth), 0.0});
        weights += distance;
      }
    }
    EXPECT_NEAR(sum / weights / ByRings(low, high, kIndex), 1.0, tests::ScaledDown(0.06, 0.12))
        << low;
  }
}

// The integral over the floor is the power of the photons that reach it.
TEST(SurfaceMap, PowerIsThatOfThePhotons) {
  const SpecularSphere glass{{0.0, 0.0, 1.5}, 1.0, SphereMaterial::kGlass, 1.5};
  const std::vector<PhotonBeam> beams = OntoFloor(glass, 2000);
  double power_m2 = 0.0;
  for (const PhotonBeam& beam : beams) power_m2 += beam.ends_on_surface ? beam.area_m2 : 0.0;
  const SurfaceMap map(beams, 0.3);
  double sum_m2 = 0.0;
  constexpr double kStep_m = 0.05, kReach_m = 12.0;
  for (double x = -kReach_m; x < kReach_m; x += kStep_m)
    for (double y = -kReach_m; y < kReach_m; y += kStep_m)
      sum_m2 += kStep_m * kStep_m * map.Irradiance({x, y, 0.0});
  EXPECT_GT(power_m2, 0.8 * kPi) << "some light goes upwards";
  EXPECT_LT(power_m2, kPi);
  EXPECT_NEAR(sum_m2 / power_m2, 1.0, 0.02) << "few photons land beyond 12 m";
}

TEST(SurfaceMap, RefusesRadiiThatAreNotPositive) {
  EXPECT_THAT(tests::FaultOf([] { return SurfaceMap({}, 0.0).Irradiance({}); }),
              testing::HasSubstr("the radius of spots [m] is 0"));
}

}  // namespace
}  // namespace alpenglow::renderer
