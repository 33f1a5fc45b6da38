// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_shadow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSphere_m = 6371000.0;
const glm::dvec3 kBeam = glm::normalize(glm::dvec3(0.6, 0.3, 0.5));

const CloudShadow& ShadowOfSpheres() {
  static const CloudShadow kShadow = [] {
    static const CloudField field = tests::SphereClouds(0.01);
    return CloudShadow({{std::make_shared<const CloudSunDepths>(field, kBeam), 1.0}},
                       field.top_altitude_m(), kSphere_m);
  }();
  return kShadow;
}

TEST(CloudShadow, EdgeHeightIsTheInverseOfSunlight) {
  for (double sunlight = 0.0; sunlight <= 1.0; sunlight += 1.0 / 64.0)
    EXPECT_NEAR(SunlightOverEdge(EdgeHeightFor(sunlight)), sunlight, 1e-3);
  EXPECT_EQ(EdgeHeightFor(0.0), -1.0);
  EXPECT_EQ(EdgeHeightFor(1.0), 1.0);
}

// Samples are 50 m apart, and edges of the spheres 20 m wide: single points are off by a tenth, means
// over 200 m by three hundredths. The path joins samples within 0.02 radii, 0.013 of the sunlight.
TEST(CloudShadow, LightOnARayIsTheTransmittanceAtItsPoints) {
  const CloudShadow& shadow = ShadowOfSpheres();
  const glm::dvec3 eye(100.0, 200.0, 2.0), direction = glm::normalize(glm::dvec3(0.9, 0.3, 0.2));
  const SunlitPath path = shadow.OnRay({{0.0, 8000.0}}, eye, direction);
  ASSERT_GT(path.size(), 3u);
  double darkest = 1.0;
  for (double begin_m = 0.0; begin_m < 2400.0; begin_m += 200.0) {
    double lit = 0.0, expected = 0.0;
    for (double at_m = 5.0; at_m < 200.0; at_m += 10.0) {
      lit += SunlightAt(path, begin_m + at_m) / 20.0;
      expected += shadow.Transmittance(eye + (begin_m + at_m) * direction) / 20.0;
    }
    EXPECT_NEAR(lit, expected, 0.03) << begin_m;
    darkest = std::min(darkest, expected);
  }
  EXPECT_LT(darkest, 0.6);
}

TEST(CloudShadow, AboveTheCloudsLightIsThatPastTerrain) {
  const CloudShadow& shadow = ShadowOfSpheres();
  const SunlitPath past_terrain{{100.0, 2000.0, 1.0, 1.0}, {2500.0, 3000.0, -1.0, 0.5}};
  const SunlitPath path =
      shadow.OnRay(past_terrain, {0.0, 0.0, 4000.0}, glm::normalize(glm::dvec3(1.0, 0.0, 0.5)));
  EXPECT_EQ(path, past_terrain);
}

// Terrain shades whole stretches; clouds dim the rest.
TEST(CloudShadow, TerrainAndCloudsShadeTogether) {
  const CloudShadow& shadow = ShadowOfSpheres();
  const glm::dvec3 eye(100.0, 200.0, 2.0), direction = glm::normalize(glm::dvec3(0.9, 0.3, 0.0));
  const SunlitPath path = shadow.OnRay({{0.0, 500.0}, {1500.0, 4000.0}}, eye, direction);
  EXPECT_EQ(SunlightAt(path, 1000.0), 0.0);
  EXPECT_NEAR(SunlightAt(path, 2000.0), shadow.Transmittance(eye + 2000.0 * direction), 0.03);
}

// Far away the mean of the field holds.
TEST(CloudShadow, BeyondItsReachTheMeanHolds) {
  const CloudShadow& shadow = ShadowOfSpheres();
  const SunlitPath path =
      shadow.OnRay({{0.0, 200e3}}, {0.0, 0.0, 1500.0}, glm::normalize(glm::dvec3(1.0, 0.2, -0.02)));
  const double far = SunlightAt(path, 150e3);
  EXPECT_GT(far, 0.5);
  EXPECT_LT(far, 0.99);
  EXPECT_NEAR(SunlightAt(path, 130e3), far, 1e-12);
}

}  // namespace
}  // namespace alpenglow::renderer
