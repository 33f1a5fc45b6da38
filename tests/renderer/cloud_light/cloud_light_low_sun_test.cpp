// SPDX-License-Identifier: MIT
// Light of clouds under a sun too low for a map of its light.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/layer.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr double kShade_m = 120e3;

glm::dvec3 EveningSun(double elevation_deg) { return tests::DirectionAt(elevation_deg, 20.0); }

CloudScatterers EveningDroplets() { return {CloudPhases(tests::LobeOf(0.85)), 1.0}; }

CloudLight EveningLight(const CloudField& field, double elevation_deg, std::size_t factor_rays) {
  return {field,
          EveningDroplets(),
          {EveningSun(elevation_deg)},
          {.low_sun = {.farthest_m = kShade_m}, .factor = {.rays = factor_rays}}};
}

/// Rays from all sides into the spheres; with odd numbers from above, with even ones from below.
CloudRay EveningRay(int i) {
  const double mu = 0.1 + 0.9 * Halton(i, 5), azimuth_rad = 2.0 * kPi * Halton(i, 7);
  const double sine = std::sqrt(1.0 - mu * mu), side = i % 2 == 0 ? 1.0 : -1.0;
  return {{1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), side > 0.0 ? 900.0 : 1600.0},
          {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), side * mu}};
}

/// Means over rays from below and from above.
struct EveningMeans {
  double from_below = 0.0, from_above = 0.0;
};
EveningMeans MeanSunlight(const CloudLight& light) {
  EveningMeans means;
  constexpr int kRays = 4000;
  for (int i = 1; i <= kRays; ++i) {
    const double sun = light.Radiance(EveningRay(i)).sun;
    (i % 2 == 0 ? means.from_below : means.from_above) += sun / (kRays / 2);
  }
  return means;
}

TEST(CloudLightLowSun, MeanLightIsThatOfTracedPaths) {
  const CloudField field = tests::SphereClouds(0.05);
  constexpr double kElevation_deg = -1.0;
  const CloudLight light =
      EveningLight(field, kElevation_deg, tests::ScaledDown<std::size_t>(6000, 500));
  const CloudPathTracer tracer(
      field, EveningDroplets(),
      {.to_sun = EveningSun(kElevation_deg), .low_sun = light.sun().low_sun()});
  double found = 0.0, traced = 0.0, squares = 0.0, count = 0.0;
  for (int i = 1; i <= tests::ScaledDown(60000, 6000); ++i) {
    const CloudRayLight fast = light.Radiance(EveningRay(i));
    if (fast.transmittance > 0.9) continue;
    CloudPathTracer::PathRandom random(5, static_cast<std::uint64_t>(i), 0);
    const double path = tracer.OnePath(EveningRay(i), random).sun;
    found += fast.sun;
    traced += path;
    squares += path * path;
    ++count;
  }
  const double error = std::sqrt(squares - traced * traced / count);
  EXPECT_NEAR(found, traced, 0.05 * traced + 3.0 * error) << kElevation_deg;
  EXPECT_LT(error, tests::ScaledDown(0.06, 0.2) * traced) << "the test must be able to fail";
}

// The sun is below the horizontal, and its beams come from below. The level flux of a beam is the
// sine of its height at the base, which is 1.5 % lower than in the middle of the layer.
TEST(CloudLightLowSun, BeamFromBelowIsScatteredBackDown) {
  const CloudField field = tests::PlaneLayer(0.4);
  const CloudLight light = EveningLight(field, -1.9, 0);
  const SolvedCloudMoments& fluxes = light.sun_moments();
  const double level = std::sin(1.9 * kRadiansPerDegree);
  EXPECT_NEAR(fluxes.up_at_top + fluxes.down_at_base, level, 0.04 * level);
  EXPECT_GT(fluxes.down_at_base, fluxes.up_at_top);
  EXPECT_EQ(light.ground_irradiance().direct, 0.0);
  EXPECT_EQ(light.ground_irradiance().diffuse, fluxes.down_at_base);
}

// By 3 degrees both are the same but for the planet, which bends by 6 m over the 9 km that a beam
// stays in the layer, and for the cells of the map.
TEST(CloudLightLowSun, LightIsContinuousWhereTheMapEnds) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudLight by_map = EveningLight(field, 3.0, 0), by_beams = EveningLight(field, 2.999, 0);
  const EveningMeans map = MeanSunlight(by_map), beams = MeanSunlight(by_beams);
  EXPECT_NEAR(map.from_below, beams.from_below, 0.03 * beams.from_below);
  EXPECT_NEAR(map.from_above, beams.from_above, 0.03 * beams.from_above);
  EXPECT_NEAR(by_map.sun_moments().up_at_top, by_beams.sun_moments().up_at_top,
              0.03 * by_beams.sun_moments().up_at_top);
  EXPECT_NEAR(by_map.sun().MeanTransmittance(), by_beams.sun().MeanTransmittance(), 0.02);
}

}  // namespace
}  // namespace alpenglow::renderer
