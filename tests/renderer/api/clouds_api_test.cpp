// SPDX-License-Identifier: MIT
#include <alpenglow/clouds.h>
#include <alpenglow/errors.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_light_fluxes.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/cloud_phase/ice_phase.h"
#include "renderer/clouds/cloud_generator.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow {
namespace {

using atmosphere::Halton;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns a ball of even extinction, 500 m wide, in the middle of 1280 m.
CloudGrid Ball(bool is_periodic) {
  constexpr int kAcross = 32, kHigh = 17;
  constexpr double kSpacing_m = 40.0, kRadius_m = 250.0;
  CloudGrid grid;
  grid.samples = {kAcross, kAcross, kHigh};
  grid.spacing_m = {kSpacing_m, kSpacing_m, kSpacing_m};
  grid.first = {.up_m = 1000.0};
  grid.particles = CloudParticles::kHenyeyGreenstein;
  grid.is_periodic = is_periodic;
  const glm::dvec3 middle_m(640.0, 640.0, 320.0);
  for (int k = 0; k < kHigh; ++k) {
    for (int j = 0; j < kAcross; ++j) {
      for (int i = 0; i < kAcross; ++i) {
        const double away_m = glm::length(kSpacing_m * glm::dvec3(i, j, k) - middle_m);
        grid.extinction_per_m.push_back(away_m < kRadius_m ? 0.03F : 0.0F);
      }
    }
  }
  return grid;
}

CloudLightOptions Unfitted(double ground_albedo = 0.0) {
  return {.surroundings = {.ground_albedo = ground_albedo}, .has_fitted_factor = false};
}

const Direction kSun = DirectionFromAngles(40.0, 130.0);

/// Returns rays from above and from the ground that pass the ball or its neighbours.
std::vector<CloudRay> RaysThroughBall(int count) {
  std::vector<CloudRay> rays;
  for (int i = 1; i <= count; ++i) {
    const double z_m = i % 2 == 0 ? 10.0 : 3000.0;
    const glm::dvec3 eye(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), z_m);
    const glm::dvec3 to(540.0 + 200.0 * Halton(i, 5), 540.0 + 200.0 * Halton(i, 7),
                        1220.0 + 200.0 * Halton(i, 11));
    rays.push_back({{eye.x, eye.y, eye.z}, {to.x - eye.x, to.y - eye.y, to.z - eye.z}});
  }
  return rays;
}

TEST(ApiClouds, LayersAreThoseOfTheGenerator) {
  const CloudField field({.genus = CloudGenus::kStratocumulus,
                          .cover = 0.5,
                          .droplets_per_cm3 = 60.0,
                          .seed = 7,
                          .wind_east_m_per_s = -3.0,
                          .wind_north_m_per_s = 2.0,
                          .period_m = 2560.0},
                         100.0);
  renderer::CloudOptions options =
      renderer::DefaultCloudOptions(renderer::CloudGenus::kStratocumulus);
  options.cover = 0.5;
  options.droplet_number_per_cm3 = 60.0;
  options.seed = 7;
  options.wind_m_per_s = {-3.0, 2.0};
  options.period_m = 2560.0;
  const renderer::CloudField made = renderer::MakeCloudField(options, 100.0);
  EXPECT_EQ(field.base_m(), made.base_altitude_m());
  EXPECT_EQ(field.top_m(), made.top_altitude_m());
  EXPECT_EQ(field.bytes(), made.bytes());
  EXPECT_TRUE(field.is_periodic());
  EXPECT_EQ(field.size_m()[0], 2560.0);
  double sum = 0.0;
  for (int i = 1; i <= 2000; ++i) {
    const LocalPoint at{2560.0 * Halton(i, 2), 2560.0 * Halton(i, 3), 850.0 + 450.0 * Halton(i, 5)};
    const double per_m = field.Extinction_per_m(at);
    EXPECT_EQ(per_m, made.Extinction_per_m({at.east_m, at.north_m, at.up_m}));
    EXPECT_EQ(field.EffectiveRadius_um(at),
              made.EffectiveRadius_um({at.east_m, at.north_m, at.up_m}));
    sum += per_m;
  }
  EXPECT_GT(sum, 0.0);
}

TEST(ApiClouds, EveryGenusHasItsUsualValues) {
  for (const auto& [genus, base_m, depth_m] : {std::tuple{CloudGenus::kCumulus, 1200.0, 1500.0},
                                               {CloudGenus::kStratocumulus, 900.0, 350.0},
                                               {CloudGenus::kAltocumulus, 4000.0, 200.0},
                                               {CloudGenus::kCirrus, 8000.0, 1200.0},
                                               {CloudGenus::kStratus, 500.0, 600.0},
                                               {CloudGenus::kCirrostratus, 7500.0, 1000.0}}) {
    const CloudField field({.genus = genus, .period_m = 2560.0});
    EXPECT_GT(field.top_m(), base_m) << static_cast<int>(genus);
    EXPECT_LT(field.base_m(), base_m + depth_m) << static_cast<int>(genus);
    EXPECT_LT(field.top_m(), base_m + 2.0 * depth_m) << static_cast<int>(genus);
  }
}

TEST(ApiClouds, GridsHaveTheirSamples) {
  CloudGrid grid = Ball(true);
  grid.effective_radius_um.assign(grid.extinction_per_m.size(), 12.0F);
  const CloudField field(grid);
  const LocalPoint middle{640.0, 640.0, 1320.0};
  EXPECT_NEAR(field.Extinction_per_m(middle), 0.03, 1e-7);
  EXPECT_NEAR(field.EffectiveRadius_um(middle), 12.0, 1e-6);
  EXPECT_NEAR(field.Extinction_per_m({640.0 + 240.0 + 20.0, 640.0, 1320.0}), 0.015, 1e-7)
      << "half way from the last sample with cloud to the next one";
  EXPECT_NEAR(field.Extinction_per_m({640.0 - 12800.0, 640.0 + 1280.0, 1320.0}), 0.03, 1e-7);
  EXPECT_EQ(field.Extinction_per_m({640.0, 640.0, 2500.0}), 0.0);
  EXPECT_EQ(field.size_m()[1], 1280.0);
  const CloudField open(Ball(false));
  EXPECT_EQ(open.Extinction_per_m({640.0, 640.0 + 1280.0, 1320.0}), 0.0);
  EXPECT_EQ(open.size_m()[1], 1240.0) << "up to the last samples";
}

TEST(ApiClouds, FastLightIsThatOfTheLayerBelow) {
  const CloudGrid grid = Ball(true);
  const CloudLight light(CloudField(grid), kSun, Unfitted(0.3));  // keeps the field
  const renderer::CloudField field({{32, 32, 16}, glm::dvec3(40.0), {0.0, 0.0, 1000.0}, true},
                                   {grid.extinction_per_m, {}, 1.0});
  renderer::CloudLightOptions options{.factor = {.rays = 0}};
  options.sun_map.cell_m = options.sun_map.step_m = 40.0;
  const glm::dvec3 sun(kSun.east, kSun.north, kSun.up);
  const renderer::CloudLight below(
      field, {renderer::CloudPhases({.kind = atmosphere::PhaseKind::kHenyeyGreenstein, .g = 0.85})},
      {sun, 0.3}, options);
  const std::vector<CloudRay> rays = RaysThroughBall(40);
  const std::vector<CloudRayLight> many = light.Scattered(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [eye, view, length_m] = rays[i];
    const renderer::CloudRayLight expected =
        below.Radiance({{eye.east_m, eye.north_m, eye.up_m},
                        glm::normalize(glm::dvec3(view.east, view.north, view.up))});
    const CloudRayLight found = light.Scattered(rays[i]);
    EXPECT_NEAR(found.sun, expected.sun, 1e-9 * expected.sun);
    EXPECT_NEAR(found.sky, expected.sky, 1e-9);
    EXPECT_NEAR(found.transmittance, expected.transmittance, 1e-9);
    EXPECT_NEAR(found.wide_transmittance, expected.scaled_transmittance, 1e-9);
    EXPECT_GE(found.wide_transmittance, found.transmittance);
    EXPECT_NEAR(found.mean_distance_m, expected.mean_distance_m, 1e-6);
    EXPECT_EQ(many[i].sun, found.sun);
    EXPECT_EQ(many[i].ground, found.ground);
  }
  EXPECT_EQ(light.bytes(), below.bytes());
  EXPECT_EQ(light.SunTransmittance({640.0, 640.0, 0.0}),
            below.SunTransmittance({640.0, 640.0, 0.0}));
}

TEST(ApiClouds, AnotherSunGivesTheSameAsANewSolution) {
  const CloudField field(Ball(true));
  const CloudLight light(field, kSun, Unfitted());
  const Direction low = DirectionFromAngles(10.0, 250.0);
  const CloudLight moved = light.WithSun(low), made(field, low, Unfitted());
  for (const CloudRay& ray : RaysThroughBall(20)) {
    EXPECT_EQ(moved.Scattered(ray).sun, made.Scattered(ray).sun);
    EXPECT_NE(moved.Scattered(ray).sun, light.Scattered(ray).sun);
  }
}

TEST(ApiClouds, SegmentsEndAtTheirLength) {
  const CloudLight light(CloudField(Ball(true)), kSun, Unfitted());
  const LocalPoint eye{640.0, 640.0, 0.0};
  const CloudRayLight before = light.Scattered({eye, {.up = 2.0}, 900.0});
  EXPECT_EQ(before.sun, 0.0);
  EXPECT_EQ(before.transmittance, 1.0);
  EXPECT_EQ(before.mean_distance_m, 0.0);
  const CloudRayLight inside = light.Scattered({eye, {.up = 2.0}, 1320.0});
  const CloudRayLight through = light.Scattered({eye, {.up = 2.0}});
  EXPECT_LT(through.transmittance, inside.transmittance);
  EXPECT_GT(through.mean_distance_m, 1000.0);
  EXPECT_LT(through.mean_distance_m, 1640.0);
}

/// Means over rays by both methods, and the standard error of that of the paths.
struct ComparedMeans {
  double found = 0.0, traced = 0.0, scatter = 0.0;

  void Add(double value, const CloudEstimate& estimate) {
    found += value;
    traced += estimate.value;
    scatter = std::hypot(scatter, estimate.standard_error);
  }
  /// Returns whether the means differ by less than a fraction and three standard errors.
  [[nodiscard]] bool AgreeWithin(double share) const {
    return std::abs(found - traced) < share * traced + 3.0 * scatter;
  }
};

TEST(ApiClouds, RadianceHasTheMeanOfPathsWithSkyAndGround) {
  const CloudField field(Ball(true));
  const CloudLight light(field, kSun, {.surroundings = {.ground_albedo = 0.5}});
  const CloudPaths paths(field, kSun, {.ground_albedo = 0.5});
  ComparedMeans sun, sky, ground;
  for (const CloudRay& ray : RaysThroughBall(tests::ScaledDown(30, 12))) {
    const CloudRadiance found = light.Radiance(ray);
    const TracedCloudRadiance traced = paths.Radiance(ray);
    sun.Add(found.sun, traced.sun);
    sky.Add(found.sky, traced.sky);
    ground.Add(found.ground, traced.ground);
    EXPECT_NEAR(light.Scattered(ray).transmittance, traced.transmittance.value,
                0.02 + 4.0 * traced.transmittance.standard_error);
    EXPECT_EQ(traced.paths, 4016U);
  }
  // Cells of 80 m are coarse for a ball of 500 m, whose light has no other error in its mean.
  EXPECT_TRUE(sun.AgreeWithin(0.08)) << sun.found << ", traced " << sun.traced;
  EXPECT_TRUE(sky.AgreeWithin(0.08)) << sky.found << ", traced " << sky.traced;
  EXPECT_TRUE(ground.AgreeWithin(0.08)) << ground.found << ", traced " << ground.traced;
  EXPECT_LT(sun.scatter, 0.05 * sun.traced) << "the test must be able to fail";
  RecordProperty("sun", std::to_string(sun.found / sun.traced - 1.0));
  RecordProperty("sky", std::to_string(sky.found / sky.traced - 1.0));
  RecordProperty("ground", std::to_string(ground.found / ground.traced - 1.0));
}

TEST(ApiClouds, LowSunsHaveTheMeanLightOfPaths) {
  for (const auto& [is_periodic, elevation_deg] : {std::pair{true, -0.8}, {false, 1.0}}) {
    const CloudField field(Ball(is_periodic));
    const Direction low = DirectionFromAngles(elevation_deg, 130.0);
    const CloudLightOptions options{.surroundings = {.ground_albedo = 0.5},
                                    .has_fitted_factor = false};
    const CloudLight light(field, low, options);
    const CloudPaths paths(field, low, options.surroundings);
    ComparedMeans sun;
    for (const CloudRay& ray : RaysThroughBall(tests::ScaledDown(12, 6)))
      sun.Add(light.Radiance(ray).sun, paths.Radiance(ray).sun);
    // Cells are coarse for a ball of 500 m; there is no fitted factor.
    EXPECT_TRUE(sun.AgreeWithin(0.12))
        << elevation_deg << ": " << sun.found << ", traced " << sun.traced;
    EXPECT_LT(sun.scatter, 0.06 * sun.traced) << "the test must be able to fail";
    RecordProperty(is_periodic ? "periodic" : "open", std::to_string(sun.found / sun.traced - 1.0));
  }
}

TEST(ApiClouds, LightIsContinuousBelowThreeDegrees) {
  const CloudField field(Ball(true));
  const CloudLight high(field, DirectionFromAngles(3.0, 130.0), Unfitted());
  const CloudLight low = high.WithSun(DirectionFromAngles(2.999, 130.0));
  double above = 0.0, below = 0.0;
  for (const CloudRay& ray : RaysThroughBall(400)) {
    above += high.Radiance(ray).sun;
    below += low.Radiance(ray).sun;
  }
  EXPECT_NEAR(below, above, 0.05 * above) << "cells of both maps are a tenth of the ball";
}

TEST(ApiClouds, TheSunIsLowerFarBehindThePlace) {
  CloudGrid grid = Ball(false);
  std::fill(grid.extinction_per_m.begin(), grid.extinction_per_m.end(), 0.0F);
  grid.extinction_per_m[0] = 1e-3F;
  const CloudLight light(CloudField(grid), DirectionFromAngles(1.0, 90.0),
                         {.surroundings = {.ground_albedo = 1.0}, .has_fitted_factor = false});
  const auto on_ground = [&](double east_m) {
    return light.Radiance({{east_m, 0.0, 10.0}, {.up = -1.0}}).sun;
  };
  const double sine = std::sin(1.0 * atmosphere::kRadiansPerDegree);
  EXPECT_NEAR(on_ground(-2000.0), sine / atmosphere::kPi, 0.03 * sine);
  EXPECT_NEAR(on_ground(-63710.0) / on_ground(-2000.0), (sine - 0.01) / (sine - 2000.0 / 6.371e6),
              0.02)
      << "the sun is lower by 0.01 after a hundredth of the radius";
  EXPECT_EQ(on_ground(-150e3), 0.0) << "the sun has set";
}

TEST(ApiClouds, FluxesAreThoseOfPathsOverBrightGround) {
  const CloudField field(Ball(true));
  const CloudLight light(field, kSun, {.surroundings = {.ground_albedo = 0.5}});
  const CloudPaths paths(field, kSun, {.ground_albedo = 0.5});
  const CloudFluxes found = light.Fluxes({1, 1}, tests::ScaledDown(20000, 2000)).front();
  const TracedCloudFluxes traced =
      paths.Fluxes({1, 1}, {.paths = tests::ScaledDown<std::size_t>(200000, 20000)}).mean;
  EXPECT_NEAR(found.up_at_top, traced.up_at_top.value,
              0.03 + 3.0 * traced.up_at_top.standard_error);
  EXPECT_NEAR(found.down_at_base, traced.down_at_base.value,
              0.03 + 3.0 * traced.down_at_base.standard_error);
  EXPECT_NEAR(found.direct_at_base, traced.direct_at_base.value,
              0.01 + 3.0 * traced.direct_at_base.standard_error);
}

TEST(ApiClouds, ColumnsBeginInTheSouthWest) {
  const CloudField field(Ball(true));
  const CloudLight light(field, DirectionFromAngles(90.0, 0.0), Unfitted());
  const CloudPaths paths(field, DirectionFromAngles(90.0, 0.0));
  const std::vector<CloudFluxes> found = light.Fluxes({4, 4}, 300);
  const CloudColumns traced = paths.Fluxes({4, 4}, {.paths = 16064});
  ASSERT_EQ(found.size(), 16U);
  ASSERT_EQ(traced.column.size(), 16U);
  EXPECT_GE(traced.photons, 16064U);
  EXPECT_NEAR(found[0].direct_at_base, 1.0, 1e-9) << "clear";
  EXPECT_LT(found[5].direct_at_base, 0.6) << "a quarter of the ball";
  double mean = 0.0;
  for (std::size_t i = 0; i < 16; ++i) {
    const CloudEstimate& direct = traced.column[i].direct_at_base;
    EXPECT_NEAR(found[i].direct_at_base, direct.value, 0.05 + 4.0 * direct.standard_error) << i;
    mean += direct.value / 16.0;
  }
  EXPECT_NEAR(mean, traced.mean.direct_at_base.value, 1e-9);
}

TEST(ApiClouds, PathsOfOneOrderScatterOnce) {
  const CloudPaths paths(CloudField(Ball(true)), kSun);
  const CloudRay ray{{640.0, 640.0, 2000.0}, {.up = -1.0}};
  const TracedCloudRadiance once = paths.Radiance(ray, {.max_order = 1});
  const TracedCloudRadiance all = paths.Radiance(ray, {.seed = 5});
  EXPECT_LT(once.sun.value + 4.0 * once.sun.standard_error, all.sun.value);
  EXPECT_NE(all.sun.value, paths.Radiance(ray).sun.value) << "another seed";
  EXPECT_GT(all.sun.standard_error, 0.0);
}

// The stated bias is 1 %; the rest are errors of the paths.
TEST(ApiClouds, SimilarPathsHaveTheLightOfPaths) {
  const CloudPaths paths(CloudField(Ball(true)), kSun, {.ground_albedo = 0.3});
  const CloudPaths similar = paths.WithSimilarity();
  const CloudPathOptions options{.paths = tests::ScaledDown<std::size_t>(100000, 20000)};
  const CloudRay ray{{640.0, 640.0, 3000.0}, {.up = -1.0}};
  const TracedCloudRadiance exact = paths.Radiance(ray, options);
  const TracedCloudRadiance found = similar.Radiance(ray, options);
  EXPECT_NE(found.sun.value, exact.sun.value);
  const double error = std::hypot(found.sun.standard_error, exact.sun.standard_error);
  EXPECT_LT(error, 0.02 * exact.sun.value) << "the test must be able to fail";
  EXPECT_NEAR(found.sun.value, exact.sun.value, 0.01 * exact.sun.value + 3.0 * error);
  EXPECT_THROW(static_cast<void>(paths.WithSimilarity(0)), InputError);
}

TEST(ApiClouds, DropletsAndIceHaveTheirPhaseFunctions) {
  CloudGrid grid = Ball(true);
  const CloudRay ray{{640.0, 640.0, 3000.0}, {.up = -1.0}};
  std::vector<double> light;
  for (const CloudParticles particles :
       {CloudParticles::kDroplets, CloudParticles::kIce, CloudParticles::kHenyeyGreenstein}) {
    grid.particles = particles;
    const CloudField field(grid);
    light.push_back(CloudPaths(field, kSun).Radiance(ray, {.max_order = 1}).sun.value);
    EXPECT_GT(CloudLight(field, kSun, Unfitted()).Scattered(ray).sun, 0.0);
  }
  const double cosine = -kSun.up;
  const double lobe = (1.0 - 0.85 * 0.85) / std::pow(1.0 + 0.85 * 0.85 - 2.0 * 0.85 * cosine, 1.5) /
                      (4.0 * atmosphere::kPi);
  // Light scattered once by the same extinction is proportional to the phase function.
  EXPECT_NEAR(light[0] / light[2], renderer::DropletPhases(550.0).Value(10.0, cosine) / lobe,
              0.1 * light[0] / light[2]);
  EXPECT_NEAR(light[1] / light[2], renderer::IcePhases(550.0).Value(10.0, cosine) / lobe,
              0.1 * light[1] / light[2]);
}

TEST(ApiClouds, UnusualGridsHaveFiniteLight) {
  CloudGrid grid;
  grid.samples = {2, 2, 2};
  grid.first = {.up_m = 500.0};
  grid.extinction_per_m.assign(8, 0.01F);
  grid.particles = CloudParticles::kHenyeyGreenstein;
  grid.single_scattering_albedo = 0.5;
  const std::vector<double> spacings_m{0.01, 1.0, 50.0, 1000.0};
  for (const double g : {0.001, 0.99}) {
    for (const double spacing_m : tests::ScaledDown(spacings_m, {0.01, 50.0})) {
      for (const bool is_periodic : {false, true}) {
        grid.g = g;
        grid.is_periodic = is_periodic;
        grid.spacing_m = {spacing_m, spacing_m, spacing_m};
        const CloudLight light(CloudField(grid), kSun, Unfitted(0.2));
        const CloudRayLight along =
            light.Scattered({{0.3 * spacing_m, 0.4 * spacing_m, 0.0}, {0.01, 0.0, 1.0}});
        EXPECT_TRUE(std::isfinite(along.sun) && along.sun >= 0.0) << g << ", " << spacing_m;
        EXPECT_TRUE(std::isfinite(along.ground) && along.ground >= 0.0) << g << ", " << spacing_m;
        if (!is_periodic) continue;
        // The last step of 40 m at most ends behind the field, where there is no cloud.
        EXPECT_GE(along.transmittance, std::exp(-0.01 * spacing_m) - 0.01) << spacing_m;
        EXPECT_LE(along.transmittance, std::exp(-0.01 * std::max(0.0, spacing_m - 20.0)) + 0.01)
            << spacing_m;
      }
    }
  }
}

TEST(ApiClouds, ClearAirLeavesAllLight) {
  CloudGrid grid = Ball(true);
  std::fill(grid.extinction_per_m.begin(), grid.extinction_per_m.end(), 0.0F);
  const CloudLight light(CloudField(grid), kSun);
  const CloudRadiance up = light.Radiance({{0.0, 0.0, 10.0}, {.up = 1.0}});
  EXPECT_EQ(up.sun, 0.0);
  EXPECT_EQ(up.sky, 1.0);
  EXPECT_EQ(light.SunTransmittance({}), 1.0);
}

/// Expects the fault that a change of valid values gives.
template <typename Values, typename Use>
void ExpectFault(Values values, const std::function<void(Values&)>& change, const Use& use,
                 const std::string& fault) {
  change(values);
  EXPECT_THAT(tests::FaultOf([&] { return use(values); }), HasSubstr(fault));
}

TEST(ApiClouds, InvalidLayersAreRefusedByName) {
  const auto expect = [](const std::function<void(CloudLayer&)>& change, const char* fault) {
    ExpectFault<CloudLayer>(
        {.period_m = 2560.0}, change,
        [](const CloudLayer& layer) { return CloudField(layer).bytes(); }, fault);
  };
  expect([](CloudLayer& layer) { layer.cover = 1.2; },
         "layer.cover is 1.2; it must lie in [0, 0.8]");
  expect([](CloudLayer& layer) { layer.cover = kNan; }, "layer.cover is nan");
  expect([](CloudLayer& layer) { layer.base_m = -1.0; },
         "layer.base_m is -1; it must lie in [0, 11000]");
  expect([](CloudLayer& layer) { layer.depth_m = 50.0; },
         "layer.depth_m is 50; it must lie in [100, 4000]");
  expect([](CloudLayer& layer) { layer.droplets_per_cm3 = 0.0; }, "layer.droplets_per_cm3 is 0");
  expect([](CloudLayer& layer) { layer.ice_mg_per_m3 = 20.0; },
         "layer.ice_mg_per_m3 is given; only a genus of ice");
  expect([](CloudLayer& layer) { layer.crystal_radius_um = 20.0; },
         "layer.crystal_radius_um is given");
  expect([](CloudLayer& layer) { layer.optical_depth = 20.0; },
         "layer.optical_depth is given; only stratus and cirrostratus");
  expect(
      [](CloudLayer& layer) {
        layer.genus = CloudGenus::kStratus;
        layer.optical_depth = kNan;
      },
      "layer.optical_depth is nan; it must lie in [0, 1000]");
  expect([](CloudLayer& layer) { layer.wind_north_m_per_s = kInfinity; },
         "layer.wind_north_m_per_s is inf");
  expect([](CloudLayer& layer) { layer.wind_east_m_per_s = -200.0; },
         "layer.wind_east_m_per_s is -200");
  expect([](CloudLayer& layer) { layer.period_m = 1e9; }, "layer.period_m is 1000000000");
  expect([](CloudLayer& layer) { layer.period_m = 3000.0; }, "must be a multiple of 2560");
  expect([](CloudLayer& layer) { layer.genus = static_cast<CloudGenus>(9); }, "layer.genus");
  expect(
      [](CloudLayer& layer) {
        layer.genus = CloudGenus::kCirrus;
        layer.droplets_per_cm3 = 100.0;
      },
      "layer.droplets_per_cm3 is given; only a genus of droplets");
  EXPECT_THAT(
      tests::FaultOf([] { return CloudField(CloudLayer{.period_m = 2560.0}, -1.0).bytes(); }),
      HasSubstr("time_s is -1; it must lie in [0, 10000000]"));
}

TEST(ApiClouds, InvalidGridsAreRefusedByName) {
  const auto expect = [](const std::function<void(CloudGrid&)>& change, const char* fault) {
    ExpectFault<CloudGrid>(
        Ball(true), change, [](const CloudGrid& grid) { return CloudField(grid).bytes(); }, fault);
  };
  expect([](CloudGrid& grid) { grid = CloudGrid(); },
         "grid.samples[0] is 0; it must lie in [2, 8192]");
  expect([](CloudGrid& grid) { grid.samples[2] = 1; }, "grid.samples[2] is 1");
  expect([](CloudGrid& grid) { grid.samples = {8192, 8192, 8192}; }, "there may be 200000000");
  expect([](CloudGrid& grid) { grid.spacing_m[1] = 0.0; },
         "grid.spacing_m[1] is 0; it must lie in [0.001, 100000]");
  expect([](CloudGrid& grid) { grid.first.up_m = kNan; }, "grid.first.up_m is nan");
  expect([](CloudGrid& grid) { grid.extinction_per_m[3] = -0.5F; },
         "grid.extinction_per_m[3] is -0.5; it must lie in [0, 1000000]");
  expect([](CloudGrid& grid) { grid.extinction_per_m[7] = std::nanf(""); },
         "grid.extinction_per_m[7] is nan");
  expect([](CloudGrid& grid) { grid.extinction_per_m.pop_back(); },
         "grid.extinction_per_m has 17407 values; grid.samples need 17408");
  expect([](CloudGrid& grid) { grid.effective_radius_um = {1.0F}; },
         "grid.effective_radius_um has 1 values");
  expect([](CloudGrid& grid) { grid.effective_radius_um.assign(17408, 0.0F); },
         "grid.effective_radius_um[0] is 0");
  expect([](CloudGrid& grid) { grid.single_scattering_albedo = 1.5; },
         "grid.single_scattering_albedo is 1.5");
  expect([](CloudGrid& grid) { grid.g = 1.0; }, "grid.g is 1; it must lie in [0.001, 0.99]");
  expect([](CloudGrid& grid) { grid.particles = static_cast<CloudParticles>(5); },
         "grid.particles");
}

TEST(ApiClouds, InvalidSunsAndSurroundingsAreRefusedByName) {
  const CloudField field(Ball(true));
  const auto expect = [&](const Direction& sun, const CloudLightOptions& options,
                          const char* fault) {
    EXPECT_THAT(tests::FaultOf([&] { return CloudLight(field, sun, options).bytes(); }),
                HasSubstr(fault));
    if (options.cell_m) return;
    EXPECT_THAT(tests::FaultOf([&] {
                  return CloudPaths(field, sun, options.surroundings).Fluxes({1, 1}, {.paths = 1});
                }),
                HasSubstr(fault));
  };
  expect(DirectionFromAngles(-4.5, 0.0), {},
         "elevation of to_sun [degrees] is -4.5; it must lie in [-4, 90]");
  expect(DirectionFromAngles(-40.0, 0.0), {}, "elevation of to_sun [degrees] is -40");
  expect({kNan, 0.0, 1.0}, {}, "a direction is (east nan");
  expect({0.0, 0.0, 0.0}, {}, "longer than 0");
  expect(kSun, {.surroundings = {.wavelength_nm = 200.0}}, "surroundings.wavelength_nm is 200");
  expect(kSun, {.surroundings = {.ground_albedo = -0.1}}, "surroundings.ground_albedo is -0.1");
  expect(kSun, {.surroundings = {.ground_m = 5000.0}}, "surroundings.ground_m is 5000");
  expect(kSun, {.surroundings = {}, .cell_m = 5.0},
         "options.cell_m is 5; it must lie in [20, 2500]");
  const CloudLight light(field, kSun, Unfitted());
  expect(kSun, {.surroundings = {.planet_radius_m = 10.0}},
         "surroundings.planet_radius_m is 10; it must lie in [100000, 1000000000]");
  EXPECT_THAT(tests::FaultOf([&] {
                return light.WithSun({0.0, 0.0, -1.0});
              }),
              HasSubstr("is -90;"));
  EXPECT_NO_THROW((void)light.WithSun(DirectionFromAngles(-4.0, 45.0))) << "the lowest sun";
}

TEST(ApiClouds, FluxesOfALowSunAreRefused) {
  const CloudField field(Ball(true));
  for (const double elevation_deg : {2.0, -1.0}) {
    const Direction low = DirectionFromAngles(elevation_deg, 0.0);
    EXPECT_THAT(tests::FaultOf([&] { return CloudLight(field, low, Unfitted()).Fluxes(); }),
                HasSubstr("for fluxes [degrees] is "));
    EXPECT_THAT(tests::FaultOf([&] { return CloudPaths(field, low).Fluxes(); }),
                HasSubstr("it must lie in [3, 90]"));
  }
}

TEST(ApiClouds, InvalidRaysAndNumbersAreRefusedByName) {
  const CloudField field(Ball(true));
  const CloudLight light(field, kSun, Unfitted());
  const CloudPaths paths(field, kSun);
  for (const auto& [ray, fault] :
       {std::pair{CloudRay{{.up_m = -1.0}, {}}, "ray.eye.up_m is -1; it must lie in [0,"},
        {CloudRay{{.east_m = kNan}, {}}, "ray.eye.east_m is nan"},
        {CloudRay{{.north_m = 1e9}, {}}, "ray.eye.north_m is 1000000000"},
        {CloudRay{{}, {.up = kNan}}, "a direction"},
        {CloudRay{{}, {}, -5.0}, "ray.length_m is -5"},
        {CloudRay{{}, {}, kNan}, "ray.length_m is nan"}}) {
    EXPECT_THAT(tests::FaultOf([&, &ray = ray] { return light.Scattered(ray); }), HasSubstr(fault));
    EXPECT_THAT(tests::FaultOf([&, &ray = ray] { return light.Scattered(std::vector{ray}); }),
                HasSubstr(fault));
    EXPECT_THAT(tests::FaultOf([&, &ray = ray] { return light.Radiance(ray); }), HasSubstr(fault));
    EXPECT_THAT(tests::FaultOf([&, &ray = ray] { return paths.Radiance(ray); }), HasSubstr(fault));
  }
  EXPECT_THAT(tests::FaultOf([&] {
                return light.Radiance({{}, {}, 10.0});
              }),
              HasSubstr("ray.length_m is 10; it must be infinite"));
  EXPECT_THAT(tests::FaultOf([&] { return paths.Radiance({}, {.paths = 0}); }),
              HasSubstr("options.paths is 0; it must lie in [1,"));
  EXPECT_THAT(tests::FaultOf([&] { return paths.Radiance({}, {.max_order = 0}); }),
              HasSubstr("options.max_order is 0"));
  EXPECT_THAT(tests::FaultOf([&] { return light.Fluxes({0, 1}); }), HasSubstr("columns[0] is 0"));
  EXPECT_THAT(tests::FaultOf([&] {
                return light.Fluxes({1, 1}, 0);
              }),
              HasSubstr("rays_per_column is 0; it must lie in [1, 10000000]"));
  EXPECT_THAT(tests::FaultOf([&] {
                return paths.Fluxes({4096, 4096});
              }),
              HasSubstr("the number of all columns is 16777216; it must lie in [1, 262144]"));
  EXPECT_THAT(tests::FaultOf([&] { return field.Extinction_per_m({.up_m = kNan}); }),
              HasSubstr("point.up_m is nan"));
}

TEST(ApiClouds, LightBeyondTheMemoryIsRefusedBeforeItIsSolved) {
  CloudGrid grid;
  grid.samples = {300, 300, 2};
  grid.spacing_m = {1e5, 1e5, 1e5};
  grid.extinction_per_m.assign(180000, 1e-5F);
  const CloudField field(grid);
  EXPECT_THAT(tests::FaultOf([&] { return CloudLight(field, kSun).bytes(); }),
              HasSubstr("light with options.cell_m 80"));
}

}  // namespace
}  // namespace alpenglow
