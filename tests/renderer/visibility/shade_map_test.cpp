// SPDX-License-Identifier: MIT
#include "renderer/visibility/heights_around.h"
#include "renderer/visibility/sun_shadow_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/elevation/mesh.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/rough_land.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSunRadius_rad = 0.00465;

glm::dvec3 SunAtDegrees(double elevation, double azimuth_from_east) {
  return tests::DirectionAt(elevation, azimuth_from_east);
}

/// Heights of a function of (x, y) over a square around the origin.
template <typename Height>
HeightRaster Raster(const Height& height, int side, double cell_m) {
  HeightRaster raster;
  raster.first_x_m = raster.first_y_m = -0.5 * cell_m * (side - 1);
  raster.cell_m = cell_m;
  raster.columns = raster.rows = side;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto [x, y] = raster.Place(column, row);
      raster.z_m.push_back(static_cast<float>(height(x, y)));
    }
  }
  return raster;
}

/// Returns the place of a node in the frame of the heights.
glm::dvec3 PlaceOf(const SunShadowMap& map, int column, int line) {
  return (map.first_u_m + map.cell_m * column) * map.sunwards +
         (map.first_v_m + map.cell_m * line) * map.across;
}

TEST(SunShadowMap, SidesAreNeverPowersOfTwo) {
  const auto wall = [](double x, double) { return std::abs(x) < 60.0 ? 800.0 : 0.0; };
  const HeightRaster heights = Raster(wall, 65, 50.0);
  for (double azimuth_deg = 0.0; azimuth_deg < 90.0; azimuth_deg += 1.0) {
    const SunShadowMap map =
        SunShadowMapOf(heights, SunAtDegrees(10.0, azimuth_deg), kSunRadius_rad, 64);
    EXPECT_EQ(map.columns, OffPowersOfTwo(map.columns)) << azimuth_deg;
    EXPECT_EQ(map.lines, OffPowersOfTwo(map.lines)) << azimuth_deg;
  }
}

TEST(SunShadowMap, OfAWallFallsByTheTangentOfTheSun) {
  const auto wall = [](double x, double) { return std::abs(x) < 60.0 ? 800.0 : 0.0; };
  const HeightRaster heights = Raster(wall, 401, 50.0);
  for (const double degrees : {2.0, 10.0, 40.0}) {
    const SunShadowMap map =
        SunShadowMapOf(heights, SunAtDegrees(degrees, 0.0), kSunRadius_rad, 1024);
    const double slope = std::tan(degrees * kRadiansPerDegree);
    const int line = map.lines / 2;
    for (int column = 1; column < map.columns - 1; ++column) {
      const double behind_m = -PlaceOf(map, column, line).x - 50.0;
      if (behind_m < 100.0) continue;
      const double expected_m = std::max(800.0 - behind_m * slope, 0.0);
      EXPECT_NEAR(static_cast<double>(map.at(column, line).x), expected_m, 30.0 * slope + 0.1)
          << "the crest lies within half a step of 25 m; " << degrees << " degrees";
      if (expected_m < 100.0) continue;
      const double half_m = behind_m * kSunRadius_rad * (1.0 + slope * slope);
      EXPECT_NEAR(static_cast<double>(map.at(column, line).y), half_m, 0.02 * half_m + 0.2)
          << "the disk's radius over the distance to the crest";
    }
  }
}

/// The height of the shade over a place by looking at the land every few metres.
double ReferenceShade(const glm::dvec3& place, const glm::dvec3& to_sun, double rim_m) {
  const double flat = std::hypot(to_sun.x, to_sun.y);
  double shade_m = -1e9;
  for (double away_m = 0.0;; away_m += 5.0) {
    const double x = place.x + away_m * to_sun.x / flat, y = place.y + away_m * to_sun.y / flat;
    if (std::max(std::abs(x), std::abs(y)) > rim_m) return shade_m;
    shade_m = std::max(shade_m, RoughLand(x, y) - away_m * to_sun.z / flat);
  }
}

TEST(SunShadowMap, IsTheHighestBeamThatRoughLandCutsOff) {
  constexpr int kSide = 241;
  constexpr double kCell_m = 60.0, kRim_m = 0.5 * kCell_m * (kSide - 1);
  const HeightRaster heights = Raster(RoughLand, kSide, kCell_m);
  for (const double degrees : {15.0, 3.0, -1.0}) {
    const glm::dvec3 to_sun = SunAtDegrees(degrees, 35.0);
    const SunShadowMap map = SunShadowMapOf(heights, to_sun, kSunRadius_rad, 1024);
    std::vector<double> errors_m;
    for (int line = 4; line < map.lines; line += 9) {
      for (int column = 4; column < map.columns; column += 9) {
        const glm::dvec3 place = PlaceOf(map, column, line);
        if (std::max(std::abs(place.x), std::abs(place.y)) > kRim_m) continue;
        errors_m.push_back(std::abs(static_cast<double>(map.at(column, line).x) -
                                    ReferenceShade(place, to_sun, kRim_m)));
      }
    }
    ASSERT_GT(errors_m.size(), 300U);
    std::sort(errors_m.begin(), errors_m.end());
    EXPECT_LT(errors_m[errors_m.size() / 2], 3.0) << "land that is bilinear in cells of 60 m";
    EXPECT_LT(errors_m[errors_m.size() * 99 / 100], 15.0) << degrees << " degrees";
  }
}

TEST(SunShadowMap, IsEmptyOverGentleLandUnderAHighSun) {
  const auto hills = [](double x, double y) {
    return 100.0 * (1.0 + std::cos(1e-3 * x)) * std::exp(-5e-8 * (x * x + y * y));
  };
  EXPECT_TRUE(
      SunShadowMapOf(Raster(hills, 201, 100.0), SunAtDegrees(50.0, 20.0), kSunRadius_rad, 512)
          .ShadesNothing());
  EXPECT_FALSE(
      SunShadowMapOf(Raster(hills, 201, 100.0), SunAtDegrees(5.0, 20.0), kSunRadius_rad, 512)
          .ShadesNothing());
  for (const double degrees : {-5.0, 85.0, 90.0}) {
    EXPECT_TRUE(
        SunShadowMapOf(Raster(hills, 201, 100.0), SunAtDegrees(degrees, 20.0), kSunRadius_rad, 512)
            .ShadesNothing());
  }
}

TEST(SunShadowMap, BoxContainsAllShadows) {
  const auto hill = [](double x, double y) { return 900.0 * std::exp(-1e-7 * (x * x + y * y)); };
  const SunShadowMap map =
      SunShadowMapOf(Raster(hill, 301, 100.0), SunAtDegrees(6.0, 200.0), 0.0046, 512);
  ASSERT_FALSE(map.ShadesNothing());
  for (int line = 0; line < map.lines; ++line) {
    for (int column = 0; column < map.columns; ++column) {
      const glm::dvec3 at = PlaceOf(map, column, line);
      if (std::max(std::abs(at.x), std::abs(at.y)) > 14900.0) continue;
      const double u = map.first_u_m + map.cell_m * column;
      const double v = map.first_v_m + map.cell_m * line;
      const auto over_m = static_cast<double>(map.at(column, line).x) - hill(at.x, at.y);
      if (over_m < 2.0) continue;
      EXPECT_TRUE(u >= map.low_u_m && u <= map.high_u_m && v >= map.low_v_m && v <= map.high_v_m);
      EXPECT_LE(static_cast<double>(map.at(column, line).x), map.ceiling_m);
    }
  }
  EXPECT_LT(map.high_v_m - map.low_v_m, 14e3) << "the flat land beside the hill is not in it";
}

TEST(HeightsAround, EqualTheMeshOfTheSameElevations) {
  ElevationGrid grid;
  const Place place{46.5, 8.0, 0.0};
  grid.step_lon_rad = 0.002 * kRadiansPerDegree;
  grid.step_lat_rad = 0.0015 * kRadiansPerDegree;
  grid.columns = grid.rows = 201;
  grid.west_rad = place.longitude_rad() - 100.0 * grid.step_lon_rad;
  grid.north_rad = place.latitude_rad() + 100.0 * grid.step_lat_rad;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column)
      grid.height_m.push_back(
          static_cast<float>(1500.0 + 900.0 * std::sin(0.11 * row) * std::cos(0.07 * column)));
  }
  const LocalFrame frame(kWgs84, place);
  const HeightRaster around = HeightsAround(grid, frame, 18e3, 721);
  EXPECT_EQ(around.at(0, 0), HeightRaster::kNothing) << "beyond the grid";
  const TriangleMesh mesh = MeshFromElevation(grid, frame);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 97) {
    const auto& p = mesh.positions[i];
    const auto x = static_cast<double>(p[0]), y = static_cast<double>(p[1]);
    if (std::max(std::abs(x), std::abs(y)) > 12e3) continue;
    const GridCell cell = CellAt(around, x, y);
    const auto between = [&](int row) {
      const float left = around.at(cell.column, row), right = around.at(cell.column + 1, row);
      return left + cell.x * (right - left);
    };
    const float low = between(cell.row);
    EXPECT_NEAR(double{low + cell.y * (between(cell.row + 1) - low)}, double{p[2]}, 6.0)
        << "bilinear in cells of 50 m over slopes that bend by 0.07 a sample of 150 m";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
