// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_hybrid.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/layer.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

// Few rays of a small field meet clouds.
constexpr std::size_t kFactorRays = 60000;
constexpr double kUnlimited_m = std::numeric_limits<double>::infinity();

glm::dvec3 SunAt35Degrees() { return tests::DirectionAt(35.0, 20.0); }

/// A field with its solution.
struct HybridStage {
  HybridStage(CloudField of, CloudScatterers by)
      : field(std::move(of)),
        scatterers(std::move(by)),
        light(field, scatterers, {SunAt35Degrees()}, {.factor = {.rays = 0}}) {}

  /// Returns the method with a factor for its number of collisions.
  [[nodiscard]] CloudHybrid With(const CloudHybridOptions& options, std::size_t rays = 0) const {
    SolvedCloudLight solved{
        light.optics(), light.sun(), light.sun_moments().moments, light.sky_moments().moments,
        nullptr,        {}};
    const CloudGather gather(field, solved.optics, solved.depths, solved.sun, solved.sky, nullptr);
    solved.factor = FitCloudFactor(field, gather, {field, scatterers, {SunAt35Degrees()}},
                                   {.rays = rays, .collisions = options.collisions.value_or(0)});
    return {field, scatterers, solved, options};
  }

  CloudField field;
  CloudScatterers scatterers;
  CloudLight light;
};

const HybridStage& SphereStage() {
  static const HybridStage kStage(tests::SphereClouds(0.05),
                                  {CloudPhases(tests::LobeOf(0.85)), 1.0});
  return kStage;
}

/// Returns rays from below and above that meet clouds, but not near the sun: there the light of few
/// paths is most of that of a ray.
std::vector<CloudRay> RaysThrough(const CloudField& field, double period_m, std::size_t count) {
  const CloudTracker tracker(field, false);
  std::vector<CloudRay> rays;
  for (int i = 1; rays.size() < count; ++i) {
    const double mu = 0.3 + 0.7 * Halton(i, 5), azimuth_rad = 2.0 * kPi * Halton(i, 7);
    const double sine = std::sqrt(1.0 - mu * mu), up = i % 2 == 0 ? 1.0 : -1.0;
    const CloudRay ray{{period_m * Halton(i, 2), period_m * Halton(i, 3), up > 0.0 ? 2.0 : 4000.0},
                       {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), up * mu}};
    if (glm::dot(ray.direction, SunAt35Degrees()) > 0.7) continue;
    if (tracker.OpticalDepth(ray, 1e6, 4.0) >= 0.3) rays.push_back(ray);
  }
  return rays;
}

/// Means over rays by both methods, and the standard error of their differences.
struct Compared {
  CloudRadiance traced;
  CloudScattered found;

  void Add(const CloudRadiance& by_paths, const CloudScattered& by_hybrid, double share) {
    AddTo(traced.sun, by_paths.sun, share);
    AddTo(traced.sky, by_paths.sky, share);
    AddTo(found.sun, by_hybrid.sun, share);
    AddTo(found.sky, by_hybrid.sky, share);
  }
  static void AddTo(CloudEstimate& sum, const CloudEstimate& each, double share) {
    sum.value += share * each.value;
    sum.standard_error = std::hypot(sum.standard_error, share * each.standard_error);
  }
};

/// Rays with their light by paths alone.
struct TracedRays {
  TracedRays(const HybridStage& of, double period_m, std::size_t count)
      : stage(of), rays(RaysThrough(of.field, period_m, count)) {
    const CloudPathTracer tracer(of.field, of.scatterers, {SunAt35Degrees()});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      traced.push_back(tracer.Radiance(rays[i], {.seed = i}));
    }
  }

  [[nodiscard]] Compared With(const CloudHybridOptions& options) const {
    const CloudHybrid hybrid = stage.With(options, kFactorRays);
    Compared compared;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CloudScattered found = hybrid.Radiance(rays[i], kUnlimited_m, i);
      if (rays[i].direction.z > 0.0) found.sky.value += found.transmittance;
      compared.Add(traced[i], found, 1.0 / static_cast<double>(rays.size()));
    }
    return compared;
  }

  const HybridStage& stage;
  std::vector<CloudRay> rays;
  std::vector<CloudRadiance> traced;
};

/// Expects that two means agree within a share of the expected one and three standard errors.
void ExpectAgreement(const CloudEstimate& found, const CloudEstimate& expected, double share) {
  const double error = std::hypot(found.standard_error, expected.standard_error);
  testing::Test::RecordProperty("difference_percent",
                                std::to_string(100.0 * (found.value / expected.value - 1.0)));
  EXPECT_NEAR(found.value, expected.value, share * expected.value + 3.0 * error);
  EXPECT_LT(error, 0.025 * expected.value) << "the test must be able to fail";
}

// --- Agreement with the exact method --------------------------------------------------------------

// The optical depth of the ray comes from steps of 5 m, whose error is below 0.5 % of light.
TEST(CloudHybrid, WithoutTheMomentsPathsAreThoseOfTheTracer) {
  const HybridStage& stage = SphereStage();
  const TracedRays rays(stage, 1280.0, tests::ScaledDown<std::size_t>(24, 14));
  const Compared compared = rays.With({std::nullopt, 4000});
  ExpectAgreement(compared.found.sun, compared.traced.sun, 0.005);
  ExpectAgreement(compared.found.sky, compared.traced.sky, 0.005);
}

// Light of the second to the last order of these small spheres is that of coarse cells, of which
// the spheres have two along a radius.
TEST(CloudHybrid, SpheresHaveTheLightOfTracedPaths) {
  const HybridStage& stage = SphereStage();
  const TracedRays rays(stage, 1280.0, 24);
  const std::vector<int> all{1, 2, 8};
  for (const int collisions : tests::ScaledDown(all, {2})) {
    SCOPED_TRACE(std::to_string(collisions) + " collisions");
    const Compared compared = rays.With({collisions, 512});
    ExpectAgreement(compared.found.sun, compared.traced.sun, 0.04);
    ExpectAgreement(compared.found.sky, compared.traced.sky, 0.02);
  }
}

CloudField SmallestCumulus() {
  CloudOptions options;
  options.seed = 3;
  options.period_m = kPeriodStep_m;
  return MakeCloudField(options);
}

TEST(CloudHybrid, CumulusHasTheLightOfTracedPaths) {
  const HybridStage stage(SmallestCumulus(), {CloudPhases(tests::LobeOf(0.85)), 1.0});
  const TracedRays rays(stage, kPeriodStep_m, tests::ScaledDown<std::size_t>(24, 14));
  const Compared compared = rays.With({2, 512});
  ExpectAgreement(compared.found.sun, compared.traced.sun, 0.04);
  ExpectAgreement(compared.found.sky, compared.traced.sky, 0.02);
}

// Sunlight that droplets scatter has too much noise for a short test.
TEST(CloudHybrid, DropletsHaveTheSkylightOfTracedPaths) {
  const HybridStage stage(SmallestCumulus(), {DropletPhases(550.0)});
  const TracedRays rays(stage, kPeriodStep_m, tests::ScaledDown<std::size_t>(12, 6));
  const Compared compared = rays.With({4, 256});
  ExpectAgreement(compared.found.sky, compared.traced.sky, 0.02);
}

// --- Properties -----------------------------------------------------------------------------------

TEST(CloudHybrid, LightOfSkyAndGroundIsAnEquilibrium) {
  const HybridStage& stage = SphereStage();
  for (const int collisions : {1, 3}) {
    const CloudHybrid hybrid = stage.With({collisions, 32});
    for (const CloudRay& ray : RaysThrough(stage.field, 1280.0, 8)) {
      const CloudScattered light = hybrid.Radiance(ray, kUnlimited_m, 7);
      // Factors of the moments are floats.
      EXPECT_NEAR(light.sky.value + light.ground.value + light.transmittance, 1.0, 1e-6);
    }
  }
}

TEST(CloudHybrid, StandardErrorsCoverTheScatterOfSeeds) {
  const HybridStage& stage = SphereStage();
  const CloudHybrid hybrid = stage.With({2, 32});
  constexpr int kSeeds = 100;
  const CloudRay ray = RaysThrough(stage.field, 1280.0, 1).front();
  double sum = 0.0, squares = 0.0, stated = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const CloudEstimate sun = hybrid.Radiance(ray, kUnlimited_m, seed).sun;
    sum += sun.value / kSeeds;
    squares += sun.value * sun.value / kSeeds;
    stated += sun.standard_error * sun.standard_error / kSeeds;
  }
  // The scatter of 100 seeds is known to 7 %. The lattice makes errors smaller than stated ones.
  const double scatter = std::sqrt(squares - sum * sum);
  EXPECT_LT(scatter, 1.2 * std::sqrt(stated));
  EXPECT_GT(scatter, 0.3 * std::sqrt(stated));
}

TEST(CloudHybrid, LightDependsOnRaySeedAndPathsAlone) {
  const HybridStage& stage = SphereStage();
  const CloudHybrid hybrid = stage.With({2, 16});
  const std::vector<CloudRay> rays = RaysThrough(stage.field, 1280.0, 16);
  tests::EqualForAnyNumberOfThreads([&] {
    std::vector<double> values(rays.size());
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
      values[i] = hybrid.Radiance(rays[i], kUnlimited_m, i).sun.value;
    });
    return values;
  });
  const CloudScattered light = hybrid.Radiance(rays[0], kUnlimited_m, 0);
  EXPECT_NE(light, hybrid.Radiance(rays[0], kUnlimited_m, 1));
  EXPECT_NE(light, stage.With({2, 18}).Radiance(rays[0], kUnlimited_m, 0));
  EXPECT_EQ(light, stage.With({2, 15}).Radiance(rays[0], kUnlimited_m, 0)) << "paths come in pairs";
}

TEST(CloudHybrid, ClearRaysHaveNoLight) {
  const CloudHybrid hybrid = SphereStage().With({});
  const CloudScattered clear = hybrid.Radiance({{0.0, 0.0, 10.0}, {0.0, 0.0, 1.0}}, 500.0, 1);
  EXPECT_EQ(clear, CloudScattered{});
}

TEST(CloudHybrid, RefusesOptionsOutOfRange) {
  EXPECT_THROW(static_cast<void>(SphereStage().With({0, 64})), InputError);
  EXPECT_THROW(static_cast<void>(SphereStage().With({1001, 64})), InputError);
  EXPECT_THROW(static_cast<void>(SphereStage().With({2, 1})), InputError);
  EXPECT_THROW(static_cast<void>(SphereStage().With({2, kMostCloudPaths + 1})), InputError);
}

// --- The choice of method -------------------------------------------------------------------------

TEST(CloudLightMethods, HaveTheLightOfThePathTracer) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudScatterers scatterers{CloudPhases(tests::LobeOf(0.85)), 1.0};
  const CloudLight light(field, scatterers, {SunAt35Degrees()},
                         {.factor = {.rays = kFactorRays}, .paths = {.paths = 512}});
  const auto rays = RaysThrough(field, 1280.0, 16);
  const CloudPathTracer tracer(field, scatterers, {SunAt35Degrees()});
  double sun = 0.0, sky = 0.0;
  for (const CloudRay& ray : rays) {
    const CloudRadiance traced = tracer.Radiance(ray);
    sun += traced.sun.value;
    sky += traced.sky.value;
  }
  for (const CloudLightMethod method : {CloudLightMethod::kHybrid, CloudLightMethod::kTraced}) {
    SCOPED_TRACE(NameOf(method));
    const CloudLight by = light.WithMethod(method);
    double found_sun = 0.0, found_sky = 0.0;
    for (const CloudRay& ray : rays) {
      const CloudRayLight along = by.Radiance(ray), fast = light.Radiance(ray);
      EXPECT_EQ(along.mean_distance_m, fast.mean_distance_m);
      EXPECT_EQ(along.scaled_transmittance, fast.scaled_transmittance);
      found_sun += along.sun;
      found_sky += along.sky + (ray.direction.z > 0.0 ? along.scaled_transmittance : 0.0);
    }
    // Noise of the paths is below 2 %.
    EXPECT_NEAR(found_sun, sun, 0.06 * sun);
    EXPECT_NEAR(found_sky, sky, 0.03 * sky);
  }
}

TEST(CloudLightMethods, GiveTheSameRayTheSameLight) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudLight light(field, {CloudPhases(tests::LobeOf(0.85)), 1.0}, {SunAt35Degrees()},
                         {.factor = {.rays = 0}, .method = CloudLightMethod::kHybrid});
  const CloudLight moved = light.WithSun(glm::dvec3(0.0, 0.0, 1.0)).WithSun(SunAt35Degrees());
  for (CloudRay ray : RaysThrough(field, 1280.0, 8)) {
    const double sun = light.Radiance(ray).sun;
    EXPECT_EQ(light.Radiance(ray).sun, sun);
    EXPECT_EQ(moved.Radiance(ray).sun, sun) << "another sun keeps the method";
    ray.origin.x += 1e-3;
    EXPECT_NE(light.Radiance(ray).sun, sun) << "noise is that of the ray";
  }
}

TEST(CloudLightMethods, HaveNames) {
  for (const std::string& name : CloudLightMethodNames()) {
    EXPECT_EQ(NameOf(CloudLightMethodFromName(name)), name);
  }
  try {
    static_cast<void>(CloudLightMethodFromName("slow"));
    ADD_FAILURE() << "an unknown name must be refused";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "method of light in clouds \"slow\" is not one of fast, hybrid, traced");
  }
}

}  // namespace
}  // namespace alpenglow::renderer
