// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numeric>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEndless_m = std::numeric_limits<double>::infinity();

/// A field with its light, for tests of rays.
struct GatherCase {
  GatherCase(const CloudField& of, const glm::dvec3& to_sun, double albedo = 1.0)
      : field(of),
        optics(std::make_shared<const CloudOptics>(
            field, CloudScatterers{CloudPhases(tests::LobeOf(0.85)), albedo})),
        map(field, to_sun),
        solver(field, optics),
        sun(solver.Sun(map).moments),
        sky(solver.Sky().moments),
        ground(solver.Ground().moments),
        gather(field, *optics, map, sun, sky, albedo < 1.0 ? &ground : nullptr) {}
  GatherCase(const GatherCase&) = delete;
  GatherCase& operator=(const GatherCase&) = delete;

  CloudField field;
  std::shared_ptr<const CloudOptics> optics;
  CloudSunDepths map;
  CloudMomentSolver solver;
  CloudMoments sun, sky, ground;
  CloudGather gather;
};

const glm::dvec3 kSunOfGather = glm::normalize(glm::dvec3(0.7, 0.3, 0.6));

/// Returns rays into the spheres from below, from above and from beside.
std::vector<CloudRay> RaysIntoSpheres(int count) {
  std::vector<CloudRay> rays;
  for (int i = 1; i <= count; ++i) {
    const double mu = 0.15 + 0.85 * Halton(i, 5), azimuth_rad = 2.0 * kPi * Halton(i, 7);
    const double sine = std::sqrt(1.0 - mu * mu), side = i % 2 == 0 ? 1.0 : -1.0;
    rays.push_back({{1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), side > 0.0 ? 800.0 : 1700.0},
                    {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), side * mu}});
  }
  return rays;
}

TEST(CloudGather, TransmittanceIsThatByQuadrature) {
  const GatherCase spheres(tests::SphereClouds(0.02), kSunOfGather);
  const CloudTracker tracker(spheres.field, false);
  double sum = 0.0, expected = 0.0, squares = 0.0;
  constexpr int kRays = 400;
  for (const CloudRay& ray : RaysIntoSpheres(kRays)) {
    const CloudRayParts parts = spheres.gather.Along(ray, kEndless_m);
    const double exact = std::exp(-tracker.OpticalDepth(ray, kEndless_m, 1.0));
    sum += parts.transmittance / kRays;
    expected += exact / kRays;
    squares += std::pow(parts.transmittance - exact, 2) / kRays;
    if (parts.transmittance > 0.0) {
      EXPECT_NEAR(parts.scaled_transmittance,
                  std::pow(parts.transmittance, spheres.optics->extinction_scale()), 1e-9);
    }
  }
  EXPECT_NEAR(sum, expected, 0.005);
  EXPECT_LT(std::sqrt(squares), 0.03) << "steps of 4 m at edges of 20 m";
}

TEST(CloudGather, ThinCloudsScatterSunlightOnce) {
  const GatherCase spheres(tests::SphereClouds(2e-5), kSunOfGather);
  const CloudTracker tracker(spheres.field, false);
  const PhaseFunction phase = tests::LobeOf(0.85);
  double found = 0.0, expected = 0.0, higher = 0.0;
  for (const CloudRay& ray : RaysIntoSpheres(300)) {
    const CloudRayParts parts = spheres.gather.Along(ray, kEndless_m);
    const double depth = tracker.OpticalDepth(ray, kEndless_m, 1.0);
    found += parts.first;
    expected += depth * Phase(phase, glm::dot(ray.direction, kSunOfGather));
    higher += std::accumulate(parts.higher.begin(), parts.higher.end(), 0.0);
  }
  // Optical depths are below 0.01, and so are the shares of light that is scattered twice.
  EXPECT_NEAR(found, expected, 0.02 * expected);
  EXPECT_LT(higher, 0.01 * expected);
}

TEST(CloudGather, PartsOfSkyAndGroundAreTheRestOfTheTransmittance) {
  const GatherCase spheres(tests::SphereClouds(0.05), kSunOfGather);
  for (const CloudRay& ray : RaysIntoSpheres(200)) {
    const CloudRayParts parts = spheres.gather.Along(ray, kEndless_m);
    EXPECT_NEAR(parts.sky + parts.ground + parts.scaled_transmittance, 1.0, 1e-6);
    EXPECT_GE(parts.sky, 0.0);
    EXPECT_GE(parts.ground, 0.0);
  }
}

TEST(CloudGather, AbsorbingCloudsAreDarkerThanConservativeOnes) {
  const GatherCase white(tests::SphereClouds(0.05), kSunOfGather);
  const GatherCase grey(tests::SphereClouds(0.05), kSunOfGather, 0.9);
  int with_cloud = 0;
  for (const CloudRay& ray : RaysIntoSpheres(200)) {
    const CloudRayParts bright = white.gather.Along(ray, kEndless_m);
    const CloudRayParts dark = grey.gather.Along(ray, kEndless_m);
    if (bright.transmittance > 0.5) continue;
    ++with_cloud;
    EXPECT_LT(dark.sky + dark.ground + dark.scaled_transmittance, 1.0);
    EXPECT_NEAR(bright.transmittance, dark.transmittance, 0.01);
  }
  EXPECT_GT(with_cloud, 20);
}

TEST(CloudGather, RaysEndAtTheirLength) {
  const GatherCase spheres(tests::SphereClouds(0.02), kSunOfGather);
  const CloudTracker tracker(spheres.field, false);
  for (const CloudRay& ray : RaysIntoSpheres(60)) {
    EXPECT_EQ(spheres.gather.Along(ray, 0.0).transmittance, 1.0);
    double before = 1.0;
    for (const double length_m : {250.0, 400.0, 700.0, 3000.0}) {
      const CloudRayParts parts = spheres.gather.Along(ray, length_m);
      EXPECT_LE(parts.transmittance, before + 1e-12);
      EXPECT_LE(parts.mean_distance_m, length_m);
      EXPECT_NEAR(parts.transmittance, std::exp(-tracker.OpticalDepth(ray, length_m, 1.0)), 0.1);
      before = parts.transmittance;
    }
  }
}

TEST(CloudGather, MeanDistanceIsThatOfTheCloud) {
  const GatherCase layer(tests::PlaneLayer(40.0), kSunOfGather);
  const CloudRay ray{{10.0, 20.0, 2400.0}, {0.0, 0.0, -1.0}};
  const CloudRayParts parts = layer.gather.Along(ray, kEndless_m);
  // The mean of an exponential with the scaled extinction, below 1000 m of clear air.
  const double scaled_per_m = 0.1 * layer.optics->extinction_scale();
  EXPECT_NEAR(parts.mean_distance_m, 1000.0 + 1.0 / scaled_per_m, 3.0) << "steps are 7 m";
}

TEST(CloudGather, RaysFromFarSeeWhatRaysFromNearSee) {
  const GatherCase spheres(tests::SphereClouds(0.05), kSunOfGather);
  double near = 0.0, far = 0.0, squares = 0.0;
  for (const CloudRay& ray : RaysIntoSpheres(300)) {
    const CloudRay from_far{ray.origin - 30000.0 * ray.direction, ray.direction};
    const CloudRayParts here = spheres.gather.Along(ray, kEndless_m);
    const CloudRayParts there = spheres.gather.Along(from_far, kEndless_m);
    near += here.first;
    far += there.first;
    squares += std::pow(here.scaled_transmittance - there.scaled_transmittance, 2) / 300.0;
  }
  EXPECT_NEAR(near, far, 0.01 * near);
  EXPECT_LT(std::sqrt(squares), 0.02) << "steps begin at other places";
}

TEST(CloudGather, HatsSumToOneAtEveryDepth) {
  double before = -1.0;
  for (const double depth : {0.0, 0.01, 1.0, 3.0, 10.0, 39.0, 40.0, 1e6}) {
    const CloudHats hats = CloudHatsAt(depth);
    EXPECT_GE(hats.share, 0.0);
    EXPECT_LE(hats.share, 1.0);
    ASSERT_LT(hats.node + 1, kCloudFactorNodes);
    const double place = static_cast<double>(hats.node) + hats.share;
    EXPECT_GE(place, before);
    before = place;
  }
  EXPECT_EQ(before, kCloudFactorNodes - 1.0);
}

}  // namespace
}  // namespace alpenglow::renderer
