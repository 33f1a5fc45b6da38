// SPDX-License-Identifier: MIT
// Paths from the eye, cones and photons agree on the light behind a glass sphere under a wide light.
#include "renderer/report/glass_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/specular/beam_map.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

constexpr double kWideLight_rad = 0.3;

CausticRay RayThrough(double column, double row) {
  const CausticView view;
  return {view.eye(), view.Direction(column, row), view.kEnd_m};
}
// In the focus, behind it, and beside it.
const std::vector<CausticRay> kRaysBehindGlass{RayThrough(18.5, 24.5), RayThrough(40.5, 20.5),
                                               RayThrough(25.5, 34.5)};

TEST(GlassPaths, HaveTheLightOfConesUnderAWideLight) {
  for (const double g : {0.0, 0.7}) {
    const ThinFog fog{.extinction_per_m = 0.1, .albedo = 0.8, .g = g};
    const SphereCaustic cones(1.0, 1.5, 5, tests::ScaledDown(300, 100), fog);
    double expected = 0.0, found = 0.0, scatter = 0.0;
    for (const CausticRay& ray : kRaysBehindGlass) {
      expected += LightOfCones(cones, ray, {kWideLight_rad, 0, tests::ScaledDown(4000, 500)});
      const CloudEstimate traced =
          LightOfGlassPaths(fog, kWideLight_rad, ray, tests::ScaledDown(1200000, 20000), 7);
      found += traced.value;
      scatter = std::hypot(scatter, traced.standard_error);
    }
    // More cones and more points of the disk change the mean of the full case by 0.6 %.
    EXPECT_NEAR(found, expected, 3.0 * scatter + tests::ScaledDown(0.01, 0.04) * expected) << g;
    EXPECT_LT(scatter, tests::ScaledDown(0.015, 0.1) * expected) << "the test must be able to fail";
  }
}

TEST(GlassPaths, NeverFindParallelLight) {
  for (const CausticRay& ray : kRaysBehindGlass)
    EXPECT_EQ(LightOfGlassPaths({}, 0.0, ray, 2000, 7).value, 0.0);
}

TEST(GlassPaths, WidePhotonsHaveTheLightOfCones) {
  const ThinFog fog{.extinction_per_m = 0.1, .albedo = 0.8};
  const SphereCaustic cones(1.0, 1.5, 5, tests::ScaledDown(300, 100), fog);
  const BeamMap map(BeamsOfBall(tests::ScaledDown(40000, 4000), kWideLight_rad), FogOf(fog), 0.1);
  for (const CausticRay& ray : kRaysBehindGlass) {
    const double expected =
        LightOfCones(cones, ray, {kWideLight_rad, 0, tests::ScaledDown(4000, 500)});
    // A radius of 0.1 m blurs the wide focus by less than its noise.
    EXPECT_NEAR(map.Radiance(ray.eye, ray.direction, ray.length_m)[0] / expected, 1.0,
                tests::ScaledDown(0.04, 0.15));
  }
}

TEST(GlassPaths, OnePointOfTheDiskIsParallelLight) {
  const SphereCaustic cones(1.0, 1.5, 5, 200, {});
  for (const CausticRay& ray : kRaysBehindGlass) {
    const double parallel = cones.Radiance(ray.eye, ray.direction, ray.length_m);
    // A disk of 1e-9 turns no ray of the 200 cones across a singular edge.
    EXPECT_NEAR(LightOfCones(cones, ray, {1e-9, 3, 1}) / parallel, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
