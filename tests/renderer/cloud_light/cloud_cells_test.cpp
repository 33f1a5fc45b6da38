// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "renderer/layer.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

TEST(CloudCells, FullCellsOfAPlaneLayerHaveItsExtinction) {
  const CloudField layer = tests::PlaneLayer(8.0);
  const CloudCells cells(layer, 80.0);
  // The period of 400 m holds 5 x 5 columns; the depth of 400 m has six levels at least.
  EXPECT_EQ(cells.count(), (std::array<int, 3>{5, 5, CloudCells::kLeastLevels}));
  EXPECT_EQ(cells.full(), 150U);
  EXPECT_EQ(cells.size(), 150U);
  for (std::size_t cell = 0; cell < cells.full(); ++cell) {
    EXPECT_NEAR(cells.Extinction_per_m(cell), 0.02, 1e-6);
  }
}

TEST(CloudCells, FullCellsHoldTheWaterOfSpheres) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudCells cells(field, 40.0);
  const glm::dvec3 cell_m = cells.cell_m();
  double by_cells = 0.0;
  for (std::size_t cell = 0; cell < cells.full(); ++cell) {
    by_cells += cells.Extinction_per_m(cell) * cell_m.x * cell_m.y * cell_m.z;
  }
  double by_points = 0.0;
  constexpr int kPoints = 100000;
  const glm::dvec3 low = field.lattice().origin_m, size = field.lattice().size_m();
  for (int i = 1; i <= kPoints; ++i) {
    const glm::dvec3 share(Halton(i, 2), Halton(i, 3), Halton(i, 5));
    by_points += field.Extinction_per_m(low + share * size) * size.x * size.y * size.z / kPoints;
  }
  // Cells at the border are full or clear: what some add, others take.
  EXPECT_NEAR(by_cells, by_points, 0.05 * by_points);
}

TEST(CloudCells, EveryPointWithCloudHasCellsAround) {
  for (const bool is_periodic : {true, false}) {
    const CloudField field = tests::SphereClouds(0.05, is_periodic);
    const CloudCells cells(field, 80.0);
    const glm::dvec3 low = field.lattice().origin_m, size = field.lattice().size_m();
    int with_cloud = 0;
    for (int i = 1; i <= 20000; ++i) {
      const glm::dvec3 share(Halton(i, 2), Halton(i, 3), Halton(i, 5));
      const glm::dvec3 point = low + share * size;
      if (field.Extinction_per_m(point) == 0.0) continue;
      ++with_cloud;
      const CloudCells::Mixture around = cells.Around(point);
      ASSERT_GT(around.count, 0);
      float sum = 0.0F;
      glm::dvec3 mean(0.0);
      for (int j = 0; j < around.count; ++j) {
        const auto at = static_cast<std::size_t>(j);
        sum += around.weight[at];
        mean += static_cast<double>(around.weight[at]) * cells.Middle(around.cell[at]);
      }
      EXPECT_NEAR(sum, 1.0F, 1e-5F);
      // Beyond the middles of the outermost cells those hold.
      const double from_edge_m =
          std::min(point.z - field.base_altitude_m(), field.top_altitude_m() - point.z);
      const bool is_in_middle = is_periodic && around.count == 8 && from_edge_m > 41.0;
      if (!is_in_middle || mean.x < 100.0 || mean.y < 100.0) continue;
      EXPECT_LT(glm::length(mean - point), 1e-2) << "trilinear weights have the point as mean";
    }
    EXPECT_GT(with_cloud, 200);
  }
}

TEST(CloudCells, MixturesRepeatWithThePeriod) {
  const CloudCells cells(tests::SphereClouds(0.05), 80.0);
  const glm::dvec3 point(310.0, 290.0, 1120.0);
  const CloudCells::Mixture here = cells.Around(point);
  const CloudCells::Mixture there = cells.Around(point + glm::dvec3(-1280.0, 12800.0, 0.0));
  ASSERT_GT(here.count, 0);
  EXPECT_EQ(here.count, there.count);
  EXPECT_EQ(here.cell, there.cell);
}

TEST(CloudCells, RunsHoldEveryStoredCellOnce) {
  const CloudCells cells(tests::SphereClouds(0.05), 40.0);
  std::vector<int> used(cells.lanes(), 0);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) ++used[cells.Lane(cell)];
  EXPECT_LE(*std::max_element(used.begin(), used.end()), 1);
  const CloudCells::Runs& all = cells.all_runs();
  EXPECT_EQ(all.run.size() * kCloudLanes, cells.lanes());
  EXPECT_EQ(all.row_first.back(), all.run.size());
  const auto full = std::count_if(all.run.begin(), all.run.end(),
                                  [](const CloudTrackRun& run) { return run.has_cloud; });
  EXPECT_EQ(static_cast<std::size_t>(full), cells.full_runs().run.size());
}

TEST(CloudCells, FullCellIsTheNearestOne) {
  const CloudCells cells(tests::SphereClouds(0.05), 40.0);
  for (std::size_t cell = 0; cell < cells.full(); ++cell) {
    EXPECT_EQ(cells.FullCellAt(cells.Middle(cell), {0.0, 0.0, -1.0}),
              static_cast<std::int32_t>(cell));
  }
  EXPECT_EQ(cells.FullCellAt({0.0, 640.0, 1400.0}, {0.0, 0.0, -1.0}), -1) << "clear air";
  const std::int32_t below = cells.FullCellAt({380.0, 330.0, 1340.0}, {0.0, 0.0, -1.0});
  ASSERT_GE(below, 0);
  EXPECT_LT(cells.Middle(static_cast<std::size_t>(below)).z, 1340.0) << "the top of a sphere";
}

TEST(CloudCells, AreNoneWithoutClouds) {
  const CloudField field({{16, 16, 8}, glm::dvec3(20.0), {0.0, 0.0, 5000.0}, true},
                         tests::SphereShape(true), tests::EvenMatter(0.05, 20.0));
  const CloudCells cells(field, 80.0);
  EXPECT_EQ(cells.size(), 0U);
  EXPECT_EQ(cells.Around({1.0, 2.0, 5000.0}).count, 0);
}

TEST(CloudCells, RefuseSidesOutOfRange) {
  const CloudField field = tests::SphereClouds(0.05);
  EXPECT_THROW(CloudCells(field, 9.0), InputError);
  EXPECT_THROW(CloudCells(field, 10001.0), InputError);
  EXPECT_THROW(CloudCells(field, std::nan("")), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
