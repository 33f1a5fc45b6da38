// SPDX-License-Identifier: MIT
#include "renderer/media/volume_cells.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "renderer/media/local_volume.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

constexpr double kFewCells = 4096.0;
const glm::dvec3 kSlabSize_m(60.0, 100.0, 80.0);

LocalVolume HomogeneousBody(VolumePlacement::Shape shape, const glm::dvec3& size_m) {
  VolumePlacement placement;
  placement.shape = shape;
  placement.size_m = size_m;
  return {placement, std::nullopt, nullptr};
}

VolumeCells CellsOf(const LocalVolume& body, double scaled_per_m) {
  return {body, {scaled_per_m, scaled_per_m, kFewCells}};
}

TEST(VolumeCells, DepthsDoubleBelowTheSurfaceOfADeepBody) {
  const LocalVolume box = HomogeneousBody(VolumePlacement::Shape::kBox, glm::dvec3(80.0));
  const VolumeCells cells = CellsOf(box, 40.0);
  EXPECT_TRUE(cells.is_limited());
  const CloudCells& finest = *cells.grids().back();
  const int count = finest.count()[0];
  double most = VolumeCells::kOuterDepth;
  for (int z = 1; z <= count / 2; ++z) {
    const std::int32_t cell = finest.FullCellOf({count / 2, count / 2, z});
    ASSERT_GE(cell, 0);
    const double density = finest.Extinction_per_m(static_cast<std::size_t>(cell));
    EXPECT_NEAR(40.0 * finest.cell_m().z * density, most, 1e-5 * most) << "floats";
    most = std::fmin(2.0 * most, VolumeCells::kMostDepth);
  }
  EXPECT_EQ(most, VolumeCells::kMostDepth);
}

TEST(VolumeCells, ThinBodiesAreWhole) {
  const LocalVolume box = HomogeneousBody(VolumePlacement::Shape::kBox, kSlabSize_m);
  const VolumeCells cells = CellsOf(box, 0.02);
  EXPECT_FALSE(cells.is_limited());
  const glm::dvec3 from(-100.0, 3.0, 40.0), along(1.0, 0.0, 0.0);
  EXPECT_NEAR(cells.Column(from, along, 1e3), kSlabSize_m.x, 1e-9);
}

TEST(VolumeCells, NumbersOfCellsAreBoundedForAnyShape) {
  const std::array<glm::dvec3, 4> sizes_m{glm::dvec3(10.0, 10.0, 2000.0),
                                          {200.0, 0.5, 60.0},
                                          {2000.0, 2000.0, 10.0},
                                          {0.01, 0.01, 2e5}};
  for (const glm::dvec3& size_m : sizes_m) {
    const LocalVolume box = HomogeneousBody(VolumePlacement::Shape::kBox, size_m);
    const VolumeCells cells = CellsOf(box, 0.5);
    // Rounding of numbers along three axes; with the axes from the longest to the shortest.
    EXPECT_LT(static_cast<double>(cells.grids().back()->full()), 1.5 * kFewCells);
    const std::array<int, 3>& count = cells.grids().back()->count();
    EXPECT_GE(count[0], count[2]);
  }
}

TEST(VolumeCells, AWayIsTheInverseOfTheColumn) {
  const LocalVolume ball = HomogeneousBody(VolumePlacement::Shape::kEllipsoid, kSlabSize_m);
  const VolumeCells cells = CellsOf(ball, 40.0);
  const glm::dvec3 eye(-200.0, -40.0, 90.0);
  const glm::dvec3 look = glm::normalize(glm::dvec3(0.0, 5.0, 42.0) - eye);
  const VolumeWay way = cells.WayAlong(eye, look, 1e3);
  for (const double distance_m : {185.0, 190.0, 205.0, 220.0}) {
    const glm::dvec3 point = eye + distance_m * look;
    EXPECT_LT(glm::length(way.At(cells.Column(eye, look, distance_m)) - point), 1e-6);
  }
  EXPECT_LT(glm::length(way.At(1e9) - eye), 300.0) << "a way ends where the body does";
}

TEST(VolumeCells, BeamsLoseThePowerOfColumns) {
  const LocalVolume box = HomogeneousBody(VolumePlacement::Shape::kBox, kSlabSize_m);
  const VolumeCells cells = CellsOf(box, 40.0);
  const CloudCells& finest = *cells.grids().back();
  const glm::dvec3 travel = glm::normalize(glm::dvec3(-0.7, 0.3, -0.6));
  const std::vector<float> beam = cells.BeamIn(finest, cells.DirectionInCells(travel), 40.0);
  const glm::dvec3& cell_m = finest.cell_m();
  double power_m2 = 0.0;
  for (std::size_t cell = 0; cell < beam.size(); ++cell) {
    power_m2 += 40.0 * finest.Extinction_per_m(cell) * cell_m.x * cell_m.y * cell_m.z *
                static_cast<double>(beam[cell]);
  }
  constexpr int kSide = 200;
  constexpr double kWidth_m = 160.0;
  const glm::dvec3 right = glm::normalize(glm::cross(travel, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dvec3 up = glm::cross(right, travel);
  double lost_m2 = 0.0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = (i % kSide + 0.5) / kSide - 0.5, y = (i / kSide + 0.5) / kSide - 0.5;
    const glm::dvec3 start = box.Middle() - 300.0 * travel + kWidth_m * (x * right + y * up);
    lost_m2 -= std::expm1(-40.0 * cells.Column(start, travel, 1e3)) * kWidth_m * kWidth_m /
               (kSide * kSide);
  }
  EXPECT_NEAR(power_m2 / lost_m2, 1.0, 0.005) << "both are sums over some ten thousand rays";
}

}  // namespace
}  // namespace alpenglow::renderer
