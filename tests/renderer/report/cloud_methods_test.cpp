// SPDX-License-Identifier: MIT
// Methods of the literature for light in clouds, and the errors by which they are judged.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/report/cloud_views.h"
#include "renderer/report/reference_methods.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

const glm::dvec3 kSunOfOctaves = TowardsAzimuth(20.0, 40.0);

TEST(CloudOctaves, OneOctaveIsThatOfPathsOfOneScattering) {
  const CloudField field = tests::SphereClouds(0.03);
  const CloudSunMap map(field, kSunOfOctaves);
  const CloudPathTracer tracer(field, {CloudPhases(tests::LobeOf(0.85)), 1.0}, {kSunOfOctaves});
  double found = 0.0, traced = 0.0, scatter = 0.0;
  for (int i = 1; i <= 60; ++i) {
    const CloudRay ray{{1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), 3000.0},
                       TowardsAzimuth(360.0 * Halton(i, 5), -30.0 - 60.0 * Halton(i, 7))};
    found += OctaveSunlight(field, map, 0.85, ray, {.count = 1}).sun;
    const CloudEstimate sun = tracer.Radiance(ray, {.max_order = 1}).sun;
    traced += sun.value;
    scatter = std::hypot(scatter, sun.standard_error);
  }
  EXPECT_NEAR(found, traced, 0.02 * traced + 3.0 * scatter);
  EXPECT_LT(scatter, 0.02 * traced) << "the test must be able to fail";
}

TEST(CloudOctaves, InAPlaneLayerAreTheirClosedForm) {
  constexpr double kDepth = 3.0, kG = 0.85;
  const CloudField field = tests::PlaneLayer(kDepth);
  const CloudSunMap map(field, kSunOfOctaves);
  const CloudRay down{{100.0, 100.0, 3000.0}, {0.0, 0.0, -1.0}};
  double expected = 0.0;
  for (int i = 0; i < 8; ++i) {
    // The integral of exp(-t - a^i t / mu) over the optical depth t from the top.
    const double power = std::pow(0.5, i), rate = 1.0 + power / kSunOfOctaves.z;
    expected += power * Phase(tests::LobeOf(kG * power), -kSunOfOctaves.z) *
                -std::expm1(-rate * kDepth) / rate;
  }
  const OctaveLight found = OctaveSunlight(field, map, kG, down);
  // Edges of 1 m and 16 bits of the map's depths change the light by less than a hundredth.
  EXPECT_NEAR(found.sun, expected, 0.015 * expected);
  EXPECT_NEAR(found.transmittance, std::exp(-kDepth), 0.02 * std::exp(-kDepth));
}

TEST(CloudErrors, SubtractTheScatterOfThePaths) {
  CloudErrors errors;
  errors.Add(1.3, {1.0, 0.1}, 1.0);
  errors.Add(0.9, {1.0, 0.1}, 1.0);
  EXPECT_NEAR(errors.Rms(), std::sqrt(0.5 * (0.09 + 0.01 - 0.02)), 1e-12);
  EXPECT_NEAR(errors.Bias(), 0.1, 1e-12);
  CloudErrors dark;
  dark.Add(0.02, {0.01, 0.0}, 1.0);
  EXPECT_NEAR(dark.Rms(), 0.2, 1e-12) << "relative to a twentieth of the mean";
}

TEST(CloudViews, RaysAreThoseOfACameraFromLeftToRightAndDown) {
  const CloudField field = tests::SphereClouds(0.03);
  const std::vector<CloudView> views = CloudViewsOf(field, 20.0);
  ASSERT_EQ(views.size(), 6U);
  const CloudRaster raster{3, 3};
  EXPECT_NEAR(glm::length(views[0].Ray(4, raster).direction - TowardsAzimuth(20.0, 25.0)), 0.0,
              1e-12)
      << "the middle";
  EXPECT_GT(views[0].Ray(1, raster).direction.z, views[0].Ray(7, raster).direction.z);
  // Azimuths grow anticlockwise, to the left.
  const glm::dvec3 left = views[0].Ray(3, raster).direction,
                   right = views[0].Ray(5, raster).direction;
  EXPECT_GT(left.y / left.x, right.y / right.x);
  for (const CloudPixel& pixel : CloudPixelsOf(field, views, {4, 3})) {
    EXPECT_GE(CloudTracker(field, false).OpticalDepth(pixel.ray, 2e5, 4.0), 0.1);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
