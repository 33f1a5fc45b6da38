// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/plane_parallel_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/layers/layer_field.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/quantile.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"
#include "tests/renderer/layers/layer_moments.h"

namespace alpenglow::renderer {
namespace {

using tests::DirectionAt;

constexpr double kLobe = 0.85;

CloudScatterers LobeScatterers(double albedo) {
  return {CloudPhases(tests::LobeOf(kLobe)), albedo};
}

/// Returns a ray that begins outside of the layers of this test, i >= 1.
CloudRay RayFromOutside(int i) {
  const bool is_upward = i % 2 == 0;
  const double mu = 0.05 + 0.95 * Halton(i, 3);
  const double azimuth_deg = 360.0 * Halton(i, 5);
  return {{700.0 * Halton(i, 7), 0.0, is_upward ? 0.0 : 2000.0},
          DirectionAt((is_upward ? 1.0 : -1.0) * std::asin(mu) / kRadiansPerDegree, azimuth_deg)};
}

/// Errors relative to 48 streams with the exact light of the first order, ascending.
std::vector<double> ErrorsOfRays(double depth, double albedo, double sun_deg) {
  const CloudField field = tests::PlaneLayer(depth);
  const glm::dvec3 to_sun = DirectionAt(sun_deg, 20.0);
  const CloudLight light(field, LobeScatterers(albedo), {.to_sun = to_sun});
  const LayerStack stack({{depth, albedo, LobeMoments(kLobe)}}, 0.0, tests::ScaledDown(48, 32));
  const LayerField truth = LayerField::UnderSun(stack, to_sun.z);
  const double rotated = 20.0 * kRadiansPerDegree;
  std::vector<double> errors;
  for (int i = 1; i <= tests::ScaledDown(200, 100); ++i) {
    const CloudRay ray = RayFromOutside(i);
    if (glm::dot(ray.direction, to_sun) > std::cos(3.0 * kRadiansPerDegree)) continue;
    const LightWay way{-ray.direction.z, std::atan2(ray.direction.y, ray.direction.x) - rotated};
    const double expected = truth.Radiance(ray.direction.z > 0.0 ? depth : 0.0, way);
    errors.push_back(std::abs(light.Radiance(ray).sun / expected - 1.0));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

// Errors are largest for thin layers, 0.97 % (root mean square) at the depth 0.5.
TEST(PlaneParallelLight, SunlightIsThatOf48Streams) {
  for (const double depth : {0.5, 5.0, 30.0}) {
    for (const double sun_deg : {60.0, 12.0}) {
      const std::vector<double> errors = ErrorsOfRays(depth, depth == 5.0 ? 0.9 : 1.0, sun_deg);
      double squares = 0.0;
      for (const double error : errors) squares += error * error;
      const std::string which = std::to_string(depth) + "_" + std::to_string(sun_deg);
      const double rms = std::sqrt(squares / static_cast<double>(errors.size()));
      RecordProperty("rms_" + which, std::to_string(rms));
      EXPECT_LT(rms, 0.01) << which;
      EXPECT_LT(tests::Quantile(errors, 0.99), 0.04) << which;
    }
  }
}

TEST(PlaneParallelLight, FluxesAreThoseOf48Streams) {
  for (const double depth : {0.5, 5.0, 30.0}) {
    const CloudField field = tests::PlaneLayer(depth);
    const glm::dvec3 to_sun = DirectionAt(35.0, 20.0);
    const CloudLight light(field, LobeScatterers(1.0), {.to_sun = to_sun});
    const LayerStack stack({{depth, 1.0, LobeMoments(kLobe)}}, 0.0, tests::ScaledDown(48, 24));
    const LayerFluxes at_base = LayerField::UnderSun(stack, to_sun.z).Fluxes(depth);
    const LayerFluxes of_sky = LayerField::UnderUniformSky(stack).Fluxes(depth);
    const CloudGroundIrradiance& ground = light.ground_irradiance();
    // The goal of layers: 0.1 % of the incident flux.
    EXPECT_NEAR(ground.direct + ground.diffuse, at_base.direct + at_base.down, 1e-3 * to_sun.z);
    EXPECT_NEAR(ground.sky, of_sky.down, 1e-3 * kPi);
    // The layer absorbs nothing. The mean transmittance of the map of sunlight is right to 1e-4.
    EXPECT_NEAR(ground.direct + ground.diffuse + light.sun_moments().up_at_top, to_sun.z, 1e-4);
  }
}

TEST(PlaneParallelLight, PartsOfARayAreTheWholeRay) {
  const CloudField field = tests::PlaneLayer(6.0);
  const CloudLight light(field, LobeScatterers(0.95), {.to_sun = DirectionAt(35.0, 20.0)});
  for (int i = 1; i <= 40; ++i) {
    const CloudRay ray = RayFromOutside(i);
    const double begin_m = 1000.0 / std::abs(ray.direction.z);
    const double length_m = 400.0 / std::abs(ray.direction.z) * Halton(i, 11);
    const double near_m = (ray.direction.z > 0.0 ? begin_m : 0.6 * begin_m) + length_m;
    const CloudRayLight whole = light.Radiance(ray);
    const CloudRayLight near = light.Radiance(ray, near_m);
    const CloudRayLight far = light.Radiance({ray.At(near_m), ray.direction});
    const double left = near.scaled_transmittance;
    EXPECT_NEAR(near.transmittance * far.transmittance, whole.transmittance, 1e-9);
    EXPECT_NEAR(near.sky + left * far.sky, whole.sky, 1e-6);
    EXPECT_NEAR(near.ground + left * far.ground, whole.ground, 1e-6);
    // Light of the far part has been turned by the near part, too, which broadens its peak.
    EXPECT_NEAR(near.sun + left * far.sun, whole.sun, 0.03 * whole.sun);
    EXPECT_LE(near.mean_distance_m, near_m);
    EXPECT_GE(whole.mean_distance_m, near.mean_distance_m);
  }
}

/// Expects the light of rays to be that of traced paths.
void ExpectTracedPaths(const CloudField& field, const glm::dvec3& to_sun,
                       const std::vector<CloudRay>& rays, double share) {
  const CloudScatterers scatterers{DropletPhases(550.0)};
  const CloudLight light(field, scatterers, {.to_sun = to_sun});
  const CloudPathTracer tracer(field, scatterers,
                               {.to_sun = to_sun, .low_sun = light.sun().low_sun()});
  CloudPathOptions options;
  options.paths = tests::ScaledDown<std::size_t>(8000, 160);
  for (const CloudRay& ray : rays) {
    const CloudRadiance traced = tracer.Radiance(ray, options);
    const CloudRayLight found = light.Radiance(ray);
    EXPECT_NEAR(found.sun, traced.sun.value, 4.0 * traced.sun.standard_error + share * found.sun);
    const double behind = ray.direction.z > 0.0 ? found.scaled_transmittance : 0.0;
    EXPECT_NEAR(found.sky + behind, traced.sky.value,
                4.0 * traced.sky.standard_error + share * found.sky);
    EXPECT_LT(traced.sun.standard_error, tests::ScaledDown(0.05, 0.5) * found.sun)
        << "the test must be able to fail";
  }
}

// The phase function of the layer is the mean over its radii; paths draw that of the place.
TEST(PlaneParallelLight, StratusHasTheLightOfTracedPaths) {
  CloudOptions options = DefaultCloudOptions(CloudGenus::kStratus);
  options.optical_depth = 5.0;
  const CloudField field = MakeCloudField(options);
  ExpectTracedPaths(field, DirectionAt(35.0, 20.0),
                    {{{0.0, 0.0, 0.0}, DirectionAt(70.0, 100.0)},
                     {{0.0, 0.0, 0.0}, DirectionAt(25.0, 40.0)},
                     {{0.0, 0.0, 0.0}, DirectionAt(25.0, 200.0)},
                     {{0.0, 0.0, 2000.0}, DirectionAt(-50.0, 60.0)},
                     {{0.0, 0.0, 2000.0}, DirectionAt(-20.0, 210.0)},
                     {{0.0, 0.0, 800.0}, DirectionAt(10.0, 90.0)},
                     {{0.0, 0.0, 800.0}, DirectionAt(-40.0, 90.0)}},
                    0.03);
}

TEST(PlaneParallelLight, ASunBelowTheHorizonLightsTheBase) {
  CloudOptions options = DefaultCloudOptions(CloudGenus::kCirrostratus);
  const CloudField field = MakeCloudField(options);
  const CloudLight light(field, LobeScatterers(1.0), {.to_sun = DirectionAt(-2.0, 20.0)});
  const CloudPathTracer tracer(
      field, LobeScatterers(1.0),
      {.to_sun = DirectionAt(-2.0, 20.0), .low_sun = light.sun().low_sun()});
  for (const CloudRay& ray : {CloudRay{{0.0, 0.0, 0.0}, DirectionAt(60.0, 60.0)},
                              CloudRay{{0.0, 0.0, 0.0}, DirectionAt(30.0, 150.0)}}) {
    const CloudRadiance traced =
        tracer.Radiance(ray, CloudPathOptions{.paths = tests::ScaledDown<std::size_t>(8000, 160)});
    // The beam is bent within the layer, which is deeper than a twentieth of the way to its base.
    EXPECT_NEAR(light.Radiance(ray).sun, traced.sun.value,
                4.0 * traced.sun.standard_error + 0.1 * traced.sun.value);
    EXPECT_GT(traced.sun.value, 3.0 * traced.sun.standard_error);
  }
}

// The lattice of a layer begins 20 m below its base, and thus below the plane of altitude 0.
TEST(PlaneParallelLight, ABaseAtTheGroundHasTheLightOfAHigherOne) {
  const auto light_at = [](double base_m, CloudLightMethod method) {
    CloudOptions options = DefaultCloudOptions(CloudGenus::kCirrostratus);
    options.ice_mg_per_m3 = 20.0;
    options.base_altitude_m = base_m;
    const CloudField field = MakeCloudField(options);
    CloudLightOptions by_method;
    by_method.method = method;
    by_method.paths.paths = tests::ScaledDown(4000, 400);
    const CloudLight light(field, LobeScatterers(1.0),
                           {.to_sun = DirectionAt(35.0, 20.0),
                            .ground_altitude_m = std::min(0.0, field.base_altitude_m())},
                           by_method);
    return light.Radiance({{0.0, 0.0, base_m - 30.0}, DirectionAt(50.0, 80.0)}).sun;
  };
  for (const CloudLightMethod method : {CloudLightMethod::kFast, CloudLightMethod::kHybrid}) {
    const double low = light_at(0.0, method), high = light_at(1000.0, method);
    // Paths differ, because their random numbers follow the ray.
    EXPECT_NEAR(low / high, 1.0, method == CloudLightMethod::kFast ? 1e-3 : 0.1);
  }
}

TEST(PlaneParallelLight, OtherFieldsAreNotPlaneParallel) {
  EXPECT_TRUE(IsPlaneParallel(tests::PlaneLayer(3.0)));
  const CloudOptions stratus = DefaultCloudOptions(CloudGenus::kStratus);
  EXPECT_TRUE(IsPlaneParallel(MakeCloudField(stratus)));
  EXPECT_TRUE(IsPlaneParallel(MakeCloudField(stratus, 12345.6))) << "moved by the wind";
  EXPECT_FALSE(IsPlaneParallel(tests::SphereClouds(0.05)));
}

}  // namespace
}  // namespace alpenglow::renderer
