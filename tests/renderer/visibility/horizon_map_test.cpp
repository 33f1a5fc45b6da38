// SPDX-License-Identifier: MIT
#include "renderer/visibility/horizon_map.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/rough_land.h"

namespace alpenglow::renderer {
namespace {

constexpr double kFlatPlanet_m = 1e15;

TEST(HeightRaster, HasTheHeightsOfTheMesh) {
  const auto plane = [](double x, double y) { return 100.0 + 0.2 * x - 0.1 * y; };
  const HeightRaster raster = RasterOf(LandMesh(plane, 31, 100.0), 1 << 12);
  EXPECT_LE(raster.z_m.size(), std::size_t{1} << 12);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const auto [x, y] = raster.Place(column, row);
      EXPECT_NEAR(static_cast<double>(raster.at(column, row)), plane(x, y), 1e-3);
    }
  }
}

TEST(HeightRaster, HasNothingWhereTheMeshHasNothing) {
  TriangleMesh mesh = LandMesh([](double, double) { return 5.0; }, 11, 10.0);
  mesh.triangles.resize(mesh.triangles.size() / 2);  // the southern half
  const HeightRaster raster = RasterOf(mesh, 1 << 10);
  EXPECT_FLOAT_EQ(raster.at(raster.columns / 2, 1), 5.0F);
  EXPECT_EQ(raster.at(raster.columns / 2, raster.rows - 2), HeightRaster::kNothing);
}

TEST(HorizonMap, AWallStandsAsHighAsItsHeightOverItsDistance) {
  // 300 m high, 1 km to the east of the middle, as long as the land.
  const auto wall = [](double x, double) { return x > 990.0 && x < 1110.0 ? 300.0 : 0.0; };
  const HorizonMap map(RasterOf(LandMesh(wall, 101, 50.0), 1 << 14), kFlatPlanet_m);
  const Horizons horizons = map.At({0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const double east = std::cos(HorizonAzimuth(i));
    const double expected = east > 0.3 ? 300.0 / std::hypot(300.0, 1000.0 / east) : 0.0;
    EXPECT_NEAR(static_cast<double>(horizons[i]), expected, 0.01)
        << "azimuth " << i << "; the wall stands between 950 and 1000 m";
  }
}

TEST(HorizonMap, OnATiltedPlainTheHorizonIsThePlainItself) {
  const auto tilted = [](double x, double y) { return 0.06 * x - 0.05 * y; };
  const HorizonMap map(RasterOf(LandMesh(tilted, 101, 50.0), 1 << 14), kFlatPlanet_m);
  const Horizons horizons = map.At({300.0, -400.0, 0.0});
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const double slope = 0.06 * std::cos(HorizonAzimuth(i)) - 0.05 * std::sin(HorizonAzimuth(i));
    EXPECT_NEAR(static_cast<double>(horizons[i]), slope / std::hypot(1.0, slope), 1e-4)
        << "azimuth " << i << "; heights are kept in float";
  }
}

TEST(HorizonMap, OnASmallPlanetTheVerticalLeansFromPlaceToPlace) {
  // 2 km from the frame's origin on a planet of 100 km the vertical leans by 0.02; the plain around
  // is level all the same: its nearest visible ground lies half a cell's curvature down.
  constexpr double kRadius_m = 1e5;
  const auto sphere = [](double x, double y) { return -(x * x + y * y) / (2.0 * kRadius_m); };
  const HorizonMap map(RasterOf(LandMesh(sphere, 101, 50.0), 1 << 14), kRadius_m);
  for (const float sine : map.At({2000.0, 0.0, 0.0}))
    EXPECT_NEAR(static_cast<double>(sine), -50.0 / (2.0 * kRadius_m), 3e-4);
}

TEST(HorizonMap, IsTheHighestOfAllThatStandsInADirection) {
  const HeightRaster raster = RasterOf(LandMesh(RoughLand, 129, 60.0), 1 << 14);
  const HorizonMap map(raster, kFlatPlanet_m);
  double sum2 = 0.0;
  int count = 0;
  for (int row = 20; row < raster.rows - 20; row += 9) {
    for (int column = 20; column < raster.columns - 20; column += 9) {
      const auto [x, y] = raster.Place(column, row);
      const Horizons horizons = map.At({x, y, 0.0});
      for (std::size_t i = 0; i < kHorizonAzimuths; i += 3) {
        const double east = std::cos(HorizonAzimuth(i)), north = std::sin(HorizonAzimuth(i));
        double highest = -1.0;
        for (double t = raster.cell_m;; t += 0.25 * raster.cell_m) {
          const double at_x = x + t * east, at_y = y + t * north;
          if (std::max(std::abs(at_x), std::abs(at_y)) > 64 * 60.0) break;
          const double rise = RoughLand(at_x, at_y) - RoughLand(x, y);
          highest = std::max(highest, rise / std::hypot(rise, t));
        }
        const double error = static_cast<double>(horizons[i]) -
                             std::max(highest, static_cast<double>(HorizonMap::kLowest));
        sum2 += error * error;
        ++count;
      }
    }
  }
  EXPECT_LT(std::sqrt(sum2 / count), 0.015) << "heights are linear over 60 m of rough land";
}

TEST(HorizonMap, TowardsAnAzimuthEachNodeHasItsOwnHorizon) {
  const HorizonMap map(RasterOf(LandMesh(RoughLand, 33, 120.0), 1 << 12), kFlatPlanet_m);
  constexpr double kAzimuth_rad = 1.0;
  const HeightRaster sines = map.Towards(kAzimuth_rad);
  for (int row = 0; row < sines.rows; row += 5) {
    for (int column = 0; column < sines.columns; column += 3) {
      const auto [x, y] = sines.Place(column, row);
      EXPECT_NEAR(static_cast<double>(sines.at(column, row)),
                  BetweenAzimuths(kAzimuth_rad).Mean(map.At({x, y, 0.0})), 1e-5)
          << "both in float";
    }
  }
}

TEST(HorizonMap, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = LandMesh(RoughLand, 65, 120.0);
  std::vector<Horizons> made;
  for (const std::size_t threads : {1U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const HorizonMap map(RasterOf(mesh, 1 << 12), kFlatPlanet_m);
    made.push_back(map.At({321.0, -123.0, 0.0}));
  }
  EXPECT_EQ(made[0], made[1]);
}

}  // namespace
}  // namespace alpenglow::renderer
