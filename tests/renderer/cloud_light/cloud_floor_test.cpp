// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr CloudColumns kFloorColumns{{40, 40}, glm::dvec2(0.0), glm::dvec2(50.0)};
constexpr std::size_t kFloorCells = 1600;

/// Light straight down or slant, with one bright column in the middle of the field.
CloudBaseLight FromOneColumn(const glm::dvec3& travel) {
  CloudBaseLight light{travel, 1.0, glm::dvec2(25.0), std::vector<float>(kFloorCells, 0.0F)};
  light.radiance[20 * 40 + 20] = 1.0F;
  return light;
}

TEST(CloudFloor, UniformLightHasTheFluxOfItsDirections) {
  const glm::dvec3 slant = glm::normalize(glm::dvec3(1.0, 2.0, -2.0));
  std::vector<CloudBaseLight> light{FromOneColumn({0.0, 0.0, -1.0}), FromOneColumn(slant)};
  for (CloudBaseLight& each : light) each.radiance.assign(kFloorCells, 0.5F);
  const CloudFloor floor(kFloorColumns, light, 700.0);
  EXPECT_NEAR(floor.At({333.0, 1999.0}), 0.5 * (1.0 + 2.0 / 3.0), 1e-5);
  EXPECT_NEAR(floor.mean(), floor.At({0.0, 0.0}), 1e-5);
}

// The variance of three means over 2 r + 1 cells is r (r + 1), and linear mixtures add 1/3 at most.
TEST(CloudFloor, LightFallsWhereItsDirectionLeadsAndSpreads) {
  const glm::dvec3 travel = glm::normalize(glm::dvec3(1.0, 0.0, -1.0));
  const CloudFloor floor(kFloorColumns, {FromOneColumn(travel)}, 250.0);
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double x_m = 50.0 * x + 25.0, light = floor.At({x_m, 50.0 * y + 25.0});
      sum += light;
      first += light * x_m;
      second += light * x_m * x_m;
    }
  }
  EXPECT_NEAR(sum, -travel.z, 1e-5) << "none is lost";
  const double middle_m = first / sum;
  EXPECT_NEAR(middle_m, 1025.0 + 250.0, 1.0);
  EXPECT_NEAR(std::sqrt(second / sum - middle_m * middle_m), CloudFloor::kTraceWidth * 250.0, 30.0)
      << "the radius is a whole number of cells";
}

TEST(CloudFloor, WithoutDepthLightStaysBelowItsColumn) {
  const CloudFloor floor(kFloorColumns, {FromOneColumn({0.0, 0.0, -1.0})}, 0.0);
  EXPECT_NEAR(floor.At({1025.0, 1025.0}), 1.0, 1e-6);
  EXPECT_EQ(floor.At({1125.0, 1025.0}), 0.0);
}

/// Returns the irradiance of sunlight from clouds at a place by paths.
double TracedOnGround(const CloudPathTracer& tracer, const glm::dvec3& place, int paths) {
  double sum = 0.0;
  for (int i = 1; i <= paths; ++i) {
    CloudPathTracer::PathRandom random(5, static_cast<std::uint64_t>(i), 0);
    const double mu = std::sqrt(Halton(i, 2)), azimuth_rad = 2.0 * kPi * Halton(i, 3);
    const double sine = std::sqrt(1.0 - mu * mu);
    const glm::dvec3 up(sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), mu);
    sum += kPi * tracer.OnePath({place, up}, random).sun / paths;
  }
  return sum;
}

/// Squares of errors of the light by place, and of its mean for all places, relative to the mean.
struct FloorErrors {
  double by_place = 0.0, by_mean = 0.0;
};

/// Ground 120 m below spheres.
FloorErrors FloorErrorsWith(double cell_m, int places) {
  constexpr double kGround_m = 880.0;
  const CloudField field = tests::SphereClouds(0.05);
  const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.7, 0.2, 0.6));
  const CloudPhases phases(tests::LobeOf(0.8));
  CloudLightOptions options;
  options.factor.rays = 0;
  options.moments.cell_m = cell_m;
  const CloudLight light(field, {phases}, {.to_sun = to_sun, .ground_altitude_m = kGround_m},
                         options);
  const CloudPathTracer tracer(field, {phases}, {.to_sun = to_sun, .ground_altitude_m = kGround_m});
  const double mean = light.ground_irradiance().diffuse;
  FloorErrors errors;
  for (int i = 1; i <= places; ++i) {
    const glm::dvec3 place(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), kGround_m);
    const double traced = TracedOnGround(tracer, place, tests::ScaledDown(2000, 500));
    errors.by_place += std::pow((mean + light.GroundDifferenceAt(place).sun - traced) / mean, 2);
    errors.by_mean += std::pow((mean - traced) / mean, 2);
  }
  return errors;
}

// Paths have a noise of a twelfth of the mean, and light of the forward peak keeps its mean.
TEST(CloudFloor, GroundHasTheLightOfTracedPathsByPlace) {
  const int places = tests::ScaledDown(24, 6);
  for (const double cell_m : {40.0, 80.0}) {
    const FloorErrors errors = FloorErrorsWith(cell_m, places);
    EXPECT_LT(std::sqrt(errors.by_place / places), tests::ScaledDown(0.2, 0.3)) << cell_m;
    EXPECT_LT(errors.by_place, tests::ScaledDown(0.5, 0.8) * errors.by_mean) << cell_m;
    EXPECT_LT(std::sqrt(errors.by_mean / places), tests::ScaledDown(0.29, 0.5))
        << "the mean for all places";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
