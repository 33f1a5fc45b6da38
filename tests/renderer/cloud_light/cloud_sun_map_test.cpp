// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_sun_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/layer.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/sphere_clouds.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

glm::dvec3 SunAt(double elevation_deg, double azimuth_deg = 20.0) {
  return tests::DirectionAt(elevation_deg, azimuth_deg);
}

double ByQuadrature(const CloudField& field, const glm::dvec3& point, const glm::dvec3& to_sun) {
  return CloudTracker(field, false).OpticalDepth({point, to_sun}, 1e6, 1.0);
}

/// Returns evenly spread points of the lattice of a field.
std::vector<glm::dvec3> PointsOf(const CloudField& field, int count) {
  const glm::dvec3 low = field.lattice().origin_m, size = field.lattice().size_m();
  std::vector<glm::dvec3> points;
  for (int i = 1; i <= count; ++i) {
    const glm::dvec3 share(Halton(i, 2), Halton(i, 3), Halton(i, 5));
    points.push_back(low + share * size);
  }
  return points;
}

TEST(CloudSunMap, PlaneLayerHasItsSlantOpticalDepth) {
  const CloudField field = tests::PlaneLayer(8.0);
  for (const double elevation_deg : {90.0, 35.0, 12.0, 3.0}) {
    const CloudSunMap map(field, SunAt(elevation_deg));
    for (const double share : {0.0, 0.123, 0.5, 0.87, 1.0}) {
      const glm::dvec3 point(777.0, -93.0, 1000.0 + 400.0 * share);
      const double depth = 8.0 * (1.0 - share) / SunAt(elevation_deg).z;
      // Depths beyond 64 are stored as 64. Rounding to 16 bits leaves 2 sqrt(64 tau) / 65535 / 2.
      EXPECT_NEAR(map.OpticalDepth(point), std::min(depth, 64.0), 1e-3 + 1e-5 * depth)
          << elevation_deg << " " << share;
    }
    EXPECT_NEAR(map.OpticalDepth({5.0, 6.0, 20.0}), std::min(8.0 / SunAt(elevation_deg).z, 64.0),
                2e-3)
        << "the ground is below the whole layer";
  }
}

TEST(CloudSunMap, ShadowsHaveTheMeanTransmittanceOfBeams) {
  const CloudField field = tests::SphereClouds(0.05);
  for (const double elevation_deg : {60.0, 35.0, 12.0}) {
    const CloudSunMap map(field, SunAt(elevation_deg), {.cell_m = 10.0});
    double by_map = 0.0, by_quadrature = 0.0;
    constexpr int kPoints = 3000;
    for (const glm::dvec3& point : PointsOf(field, kPoints)) {
      const glm::dvec3 on_ground(point.x, point.y, 0.0);
      by_map += map.Transmittance(on_ground) / kPoints;
      by_quadrature += std::exp(-ByQuadrature(field, on_ground, map.to_sun())) / kPoints;
    }
    EXPECT_NEAR(by_map, by_quadrature, 0.01 * by_quadrature) << elevation_deg;
    EXPECT_NEAR(map.MeanTransmittance(), by_quadrature, 0.01) << "3000 points scatter by 0.005";
  }
}

TEST(CloudSunMap, TransmittanceAroundIsTheMeanOfItsNeighbourhood) {
  const CloudField field = tests::SphereClouds(0.05);
  for (const double elevation_deg : {60.0, 35.0}) {
    const CloudSunMap map(field, SunAt(elevation_deg));
    double around = 0.0, squares = 0.0;
    constexpr int kSide = 256;
    const glm::dvec3 low = field.lattice().origin_m, size = field.lattice().size_m();
    for (int i = 0; i < kSide * kSide; ++i) {
      const glm::dvec3 on_ground(low.x + size.x * (i % kSide + 0.5) / kSide,
                                 low.y + size.y * (i / kSide + 0.5) / kSide, 0.0);
      const double blurred = map.TransmittanceAround(on_ground);
      around += blurred / (kSide * kSide);
      double mean = 0.0;  // over a square of the size of a block
      for (int k = 0; k < 16; ++k) {
        const glm::dvec3 beside(20.0 * (k % 4) - 30.0, 20.0 * (k / 4) - 30.0, 0.0);
        mean += map.Transmittance(on_ground + beside) / 16.0;
      }
      squares += (blurred - mean) * (blurred - mean) / (kSide * kSide);
    }
    EXPECT_NEAR(around, map.MeanTransmittance(), 1e-3);
    // Between blocks, the interpolation blurs the mean once more: spheres are 130 to 240 m wide.
    EXPECT_LT(std::sqrt(squares), 0.08);
  }
}

/// Mean and root mean square of errors of the direct transmittance at points weighted by extinction,
/// over its mean.
struct SunErrors {
  double bias, rms;
};
SunErrors ErrorsAtEvents(const CloudField& field, const CloudSunMap& map, int points) {
  double extinction = 0.0, truth = 0.0, bias = 0.0, squares = 0.0;
  for (const glm::dvec3& point : PointsOf(field, points)) {
    const double weight = field.DetailedExtinction_per_m(point);
    if (weight == 0.0) continue;
    const double exact = std::exp(-ByQuadrature(field, point, map.to_sun()));
    const double error = std::exp(-OpticalDepthToSun(field, map, point)) - exact;
    extinction += weight;
    truth += weight * exact;
    bias += weight * error;
    squares += weight * error * error;
  }
  return {bias / truth, std::sqrt(squares / extinction) / (truth / extinction)};
}

TEST(CloudSunMap, SunlightAtEventsIsWithinOnePercent) {
  const CloudField field = tests::SphereClouds(0.05);
  for (const double elevation_deg : {35.0, 12.0}) {
    const SunErrors errors = ErrorsAtEvents(field, CloudSunMap(field, SunAt(elevation_deg)), 40000);
    EXPECT_NEAR(errors.bias, 0.0, 0.01) << elevation_deg;
    EXPECT_LT(errors.rms, 0.15) << elevation_deg;
    RecordProperty("rms", std::to_string(errors.rms));
  }
}

TEST(CloudSunMap, FirstCollisionsAreWhatBeamsLose) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudSunMap map(field, SunAt(35.0));
  double collided_m2 = 0.0;
  bool is_inside = true;
  map.EachPart([&](const CloudSunMap::BeamPart& part) {
    EXPECT_GE(part.depth_below, part.depth_above);
    collided_m2 += part.area_m2 * (std::exp(-part.depth_above) - std::exp(-part.depth_below));
    is_inside = is_inside && part.middle.z > field.base_altitude_m() &&
                part.middle.z < field.top_altitude_m();
  });
  EXPECT_TRUE(is_inside);
  const glm::dvec3 size_m = field.lattice().size_m();
  // The sum telescopes along each beam, so that only rounding is left.
  EXPECT_NEAR(collided_m2 / (size_m.x * size_m.y), 1.0 - map.MeanTransmittance(), 1e-9);
}

TEST(CloudSunMap, RepeatsWithThePeriodOfTheField) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudSunMap map(field, SunAt(20.0));
  for (const glm::dvec3& point : PointsOf(field, 200)) {
    const double depth = map.OpticalDepth(point);
    // Rounding of places by 1e-11 m changes depths by less than their float does.
    EXPECT_NEAR(map.OpticalDepth(point + glm::dvec3(-1280.0, 12800.0, 0.0)), depth,
                1e-5 + 1e-5 * depth);
  }
}

TEST(CloudSunMap, OpenFieldsHaveClearAirAround) {
  const CloudField field = tests::SphereClouds(0.05, false);
  const glm::dvec3 to_sun = SunAt(30.0, 200.0);
  const CloudSunMap map(field, to_sun);
  double most = 0.0, sum = 0.0, expected = 0.0, squares = 0.0;
  constexpr int kPoints = 2000;
  for (const glm::dvec3& point : PointsOf(field, kPoints)) {
    // The shadow falls beside the box.
    const glm::dvec3 ground = point - point.z / to_sun.z * to_sun;
    most = std::max(most, map.OpticalDepth(ground));
    EXPECT_EQ(map.OpticalDepth(ground + glm::dvec3(4000.0, 0.0, 0.0)), 0.0);
    EXPECT_EQ(map.OpticalDepth(ground - glm::dvec3(0.0, 4000.0, 0.0)), 0.0);
    const double exact = std::exp(-ByQuadrature(field, ground, to_sun));
    const double error = map.Transmittance(ground) - exact;
    sum += error / kPoints;
    expected += exact / kPoints;
    squares += error * error / kPoints;
  }
  EXPECT_NEAR(sum, 0.0, 0.01 * expected);
  EXPECT_LT(std::sqrt(squares), 0.1) << "cells of 20 m blur edges of 20 m";
  EXPECT_GT(most, 5.0);
}

TEST(CloudSunMap, StoresOnlyPartsOfBeamsWithCloud) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudSunMap map(field, {0.0, 0.0, 1.0});
  std::size_t parts = 0;
  map.EachPart([&](const CloudSunMap::BeamPart&) { ++parts; });
  // Each of 64 x 64 beams has a word of bits and a place, each part two bytes, and so has each of
  // 16 x 16 x 6 blocks.
  EXPECT_EQ(map.bytes(), 64U * 64U * 12U + 2U * parts + 2U * 16U * 16U * 6U);
  EXPECT_LT(parts, 64U * 64U * 24U / 6U) << "clouds cover a fifth of the sky and not all levels";
}

TEST(CloudSunMap, BeamsOfALowSunEndWhereTheyAreOpaque) {
  const CloudField field = tests::PlaneLayer(100.0);
  const CloudSunMap map(field, SunAt(35.0, 0.0));
  std::size_t parts = 0;
  double collided_m2 = 0.0;
  map.EachPart([&](const CloudSunMap::BeamPart& part) {
    ++parts;
    collided_m2 += part.area_m2 * (std::exp(-part.depth_above) - std::exp(-part.depth_below));
  });
  // The whole depth is 174, of which the upper 37 % are stored, in levels of 20 m. Beams that are
  // 20 m apart have feet 33 m apart along x: a multiple of four of them fits.
  EXPECT_EQ(parts, 12U * 20U * 8U);
  EXPECT_NEAR(collided_m2, 400.0 * 400.0, 1e-3);
  EXPECT_NEAR(map.OpticalDepth({0.0, 0.0, 0.0}), 64.0, 1e-3) << "floats";
}

TEST(CloudSunMap, IsTheSameForAnyNumberOfThreads) {
  const CloudField field = tests::SphereClouds(0.05);
  tests::EqualForAnyNumberOfThreads([&] { return CloudSunMap(field, SunAt(35.0)).hash(); });
}

TEST(CloudSunMap, IsEmptyForAFieldWithoutClouds) {
  const CloudField field({{16, 16, 8}, glm::dvec3(20.0), {0.0, 0.0, 5000.0}, true},
                         tests::SphereShape(true), tests::EvenMatter(0.05, 20.0));
  const CloudSunMap map(field, SunAt(35.0));
  EXPECT_EQ(map.OpticalDepth({3.0, 4.0, 10.0}), 0.0);
  EXPECT_EQ(map.MeanTransmittance(), 1.0);
}

TEST(CloudSunMap, RefusesASunBelowThreeDegrees) {
  const CloudField field = tests::SphereClouds(0.05);
  EXPECT_THROW(CloudSunMap(field, SunAt(2.9)), InputError);
  EXPECT_THROW(CloudSunMap(field, SunAt(-10.0)), InputError);
  EXPECT_THROW(CloudSunMap(field, {0.0, 0.0, 2.0}), InputError);
  EXPECT_THROW(CloudSunMap(field, SunAt(35.0), {.cell_m = 0.0}), InputError);
  EXPECT_THROW(CloudSunMap(field, SunAt(35.0), {.step_m = std::nan("")}), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
