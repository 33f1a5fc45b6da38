// SPDX-License-Identifier: MIT
// Tests of meshes of elevation models.
#include "renderer/elevation/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <utility>

#include "atmosphere/math/constants.h"
#include "tests/renderer/elevation/grid_in_degrees.h"

namespace alpenglow::renderer {
namespace {

// Returns the number of edges of a single triangle.
std::size_t BorderEdges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      ++uses[{low, high}];
    }
  }
  std::size_t border = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count == 1) ++border;
  }
  return border;
}

double LongestEdge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, glm::length(ToDouble(mesh.positions[triangle[k]]) -
                                              ToDouble(mesh.positions[triangle[(k + 1) % 3]])));
    }
  }
  return longest;
}

// Hard case 16.
TEST(MeshFromElevation, VerticesLieAtTheirHeightOverTheEllipsoid) {
  const ElevationGrid grid = tests::GridInDegrees(
      47.0, 7.5, {0.01, 0.01}, 101, 101, [](int row, int column) { return 10.0 * row + column; });
  const LocalFrame frame = tests::FrameAt(46.5, 8.0);
  const TriangleMesh mesh = MeshFromElevation(grid, frame);
  ASSERT_EQ(mesh.positions.size(), 101U * 101U);
  ASSERT_EQ(mesh.triangles.size(), 2U * 100U * 100U);
  for (int row = 0; row < 101; row += 10) {
    for (int column = 0; column < 101; column += 10) {
      const Place place =
          frame.GeodeticFromEnu({ToDouble(mesh.positions[grid.index(row, column)])});
      EXPECT_NEAR(place.height_m, 10.0 * row + column, 4e-3) << "float rounds 67 km by 4 mm";
      EXPECT_NEAR(place.latitude_rad(), grid.LatitudeOfRow(row), 1e-9);
      EXPECT_NEAR(place.longitude_rad(), grid.LongitudeOfColumn(column), 1e-9);
    }
  }
}

TEST(MeshFromElevation, ADistantPeakSinksWithTheEllipsoid) {
  // The peak is due north, in the meridian's plane: an independent formula in long double.
  const long double a = 6378137.0L;
  const long double f = 1.0L / 298.257223563L;
  const long double e2 = f * (2.0L - f);
  const double latitude = 45.0;
  const double peak_latitude = 46.35;
  const double peak_m = 3000.0;
  const auto axis_and_equator = [&](long double latitude_rad, long double height) {
    const long double n =
        a / std::sqrt(1.0L - e2 * std::sin(latitude_rad) * std::sin(latitude_rad));
    return std::pair((n + height) * std::cos(latitude_rad),
                     (n * (1.0L - e2) + height) * std::sin(latitude_rad));
  };
  const long double phi0 = static_cast<long double>(latitude * kRadiansPerDegree);
  const long double phi1 = static_cast<long double>(peak_latitude * kRadiansPerDegree);
  const auto [x0, z0] = axis_and_equator(phi0, 0.0L);
  const auto [x1, z1] = axis_and_equator(phi1, static_cast<long double>(peak_m));
  const long double up = (x1 - x0) * std::cos(phi0) + (z1 - z0) * std::sin(phi0);
  const ElevationGrid grid = tests::GridInDegrees(
      peak_latitude, 8.0, {0.01, 0.01}, 3, 3,
      [&](int row, int column) { return row == 0 && column == 0 ? peak_m : 0.0; });
  const TriangleMesh mesh = MeshFromElevation(grid, tests::FrameAt(latitude, 8.0));
  EXPECT_NEAR(static_cast<double>(mesh.positions[0][2]), static_cast<double>(up), 1e-3)
      << "float at 1.2 km";
  EXPECT_NEAR(static_cast<double>(up), peak_m - 150.0e3 * 150.0e3 / (2.0 * 6.367e6), 3.0)
      << "and a sphere says about the same: 150 km away the ground is 1767 m down";
}

// Hard case 17.
TEST(MeshFromElevation, ARingAroundAPoleIsClosedThereAndAtItsSeam) {
  for (const bool north : {true, false}) {
    const ElevationGrid grid =
        tests::GridInDegrees(north ? 89.995 : -89.995 + 0.07, -180.0, {0.01, 10.0}, 8, 36,
                             [](int row, int) { return 5.0 * row; });
    const LocalFrame frame = tests::FrameAt(north ? 90.0 : -90.0, 0.0);
    const TriangleMesh mesh = MeshFromElevation(grid, frame);
    EXPECT_EQ(mesh.positions.size(), 8U * 36U + 1U);
    EXPECT_EQ(mesh.triangles.size(), 2U * 7U * 36U + 36U);
    EXPECT_EQ(BorderEdges(mesh), 36U) << "only the outer ring is a border";
    EXPECT_LT(LongestEdge(mesh), 2500.0) << "no triangle reaches across";
    for (const auto& normal : mesh.normals) EXPECT_GT(normal[2], 0.99F);
  }
}

TEST(MeshFromElevation, TrianglesAtAVoidAreLeftOut) {
  const ElevationGrid grid =
      tests::GridInDegrees(46.0, 8.0, {0.001, 0.001}, 5, 5, [](int row, int column) {
        return row == 2 && column == 2 ? std::numeric_limits<double>::quiet_NaN() : 100.0;
      });
  const TriangleMesh mesh = MeshFromElevation(grid, tests::FrameAt(46.0, 8.0));
  EXPECT_EQ(mesh.positions.size(), 24U);
  EXPECT_EQ(mesh.triangles.size(), 12U * 2U + 4U) << "four cells lose the half at the void";
  for (const auto& position : mesh.positions) {
    for (const float coordinate : position) EXPECT_TRUE(std::isfinite(coordinate));
  }
}

TEST(MeshFromElevation, NormalsOfASlopeAreRight) {
  // The slope is 30 m a step north. A step in metres is the meridian's radius times the angle.
  const double step_m = 6.3671e6 * 0.001 * kRadiansPerDegree;
  const ElevationGrid grid = tests::GridInDegrees(45.0 + 0.01, 8.0 - 0.01, {0.001, 0.001}, 21, 21,
                                                  [](int row, int) { return 1000.0 - 30.0 * row; });
  const TriangleMesh mesh = MeshFromElevation(grid, tests::FrameAt(45.0, 8.0));
  const auto& normal = mesh.normals[grid.index(10, 10)];
  EXPECT_NEAR(normal[0], 0.0, 1e-4);
  EXPECT_NEAR(normal[1] / normal[2], -30.0 / step_m, 1e-4);
}

// Hard case 18.
TEST(MeshFromElevation, ACrestAlongADiagonalStaysWhole) {
  const ElevationGrid grid =
      tests::GridInDegrees(46.0, 8.0, {0.001, 0.001}, 9, 9,
                           [](int row, int column) { return row + column == 8 ? 100.0 : 0.0; });
  const TriangleMesh mesh = MeshFromElevation(grid, tests::FrameAt(46.0, 8.0));
  int crest_edges = 0;
  for (const auto& triangle : mesh.triangles) {
    int high = 0;
    for (const std::uint32_t vertex : triangle) high += mesh.positions[vertex][2] > 50.0F ? 1 : 0;
    crest_edges += high == 2 ? 1 : 0;
  }
  EXPECT_EQ(crest_edges, 16) << "each of 8 pieces of the crest is an edge of two triangles";
}

// Hard case 17.
TEST(MeshFromElevation, GroundOver180DegreesAndGreenwichIsOnePiece) {
  const auto mesh_at = [](double latitude, double west, double eye) {
    return MeshFromElevation(tests::GridInDegrees(latitude + 0.1, west, {0.01, 0.01}, 21, 21,
                                                  [](int row, int column) {
                                                    return 20.0 * ((row * 7 + column * 3) % 11);
                                                  }),
                             tests::FrameAt(latitude, eye));
  };
  struct Case {
    double latitude, west, eye;
  };
  // Rasters count longitudes from -180 or from 0 degrees.
  for (const Case& over : {Case{-17.1, 179.9, 180.0},
                           {51.5, -0.1, 0.0},
                           {51.5, -0.1, 360.0},
                           {51.5, 359.9, 0.0},
                           {51.5, 359.9, 360.0}}) {
    const TriangleMesh mesh = mesh_at(over.latitude, over.west, over.eye);
    const TriangleMesh same = mesh_at(over.latitude, 19.9, 20.0);
    ASSERT_EQ(mesh.triangles, same.triangles) << over.west;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_LT(glm::length(ToDouble(mesh.positions[i]) - ToDouble(same.positions[i])), 2e-3)
          << "the earth is the same at every meridian; float rounds 16 km by 1 mm";
    }
    EXPECT_EQ(BorderEdges(mesh), 4U * 20U);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
