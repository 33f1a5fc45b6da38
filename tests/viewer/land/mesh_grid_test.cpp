// SPDX-License-Identifier: MIT
#include "viewer/land/mesh_land.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

const GeodeticPosition kPlace = PlaceFromDegrees(46.5, 8.0, 0.0);
const LocalFrame kFrame(kWgs84, kPlace);

/// A square in the frame, its middle east of the origin, that rises to the east by a tenth.
Terrain SlopeAt(float east_m, float half_m) {
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}})
    mesh.positions.push_back({east_m + x * half_m, y * half_m, 100.0F + 0.1F * x * half_m});
  mesh.normals.assign(4, {0.0F, 0.0F, 1.0F});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return Terrain(std::move(mesh));
}

double ShareOnMesh(const ElevationGrid& grid) {
  double there = 0.0;
  for (const float height_m : grid.height_m) there += std::isnan(height_m) ? 0.0 : 1.0;
  return there / static_cast<double>(grid.height_m.size());
}

TEST(MeshGrid, ASmallMeshIsSampledAllOverFromAnywhere) {
  for (const float half_m : {0.2F, 20.0F, 30.0F}) {
    const Terrain mesh = SlopeAt(0.0F, half_m);
    const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 64);
    ASSERT_TRUE(grid) << half_m;
    EXPECT_GT(ShareOnMesh(*grid),
              0.9 * std::pow(static_cast<double>(half_m / (half_m + 3.0F)), 2.0))
        << half_m << ": the box around it is up to 3 m wider";
    EXPECT_NEAR(*grid->HeightAt(kPlace.latitude_rad, kPlace.longitude_rad), 100.0, 0.01);
  }
}

TEST(MeshGrid, AMeshFarAwayIsSampledWhereItIs) {
  for (const float east_m : {33e3F, 45e3F, 72e3F, -150e3F}) {
    const Terrain mesh = SlopeAt(east_m, 1000.0F);
    const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 64);
    ASSERT_TRUE(grid) << east_m;
    EXPECT_GT(ShareOnMesh(*grid), 0.9) << east_m;
    const GeodeticPosition middle =
        kFrame.GeodeticFromEnu({{static_cast<double>(east_m), 0.0, 100.0}});
    EXPECT_NEAR(*grid->HeightAt(middle.latitude_rad, middle.longitude_rad), middle.height_m, 0.5);
  }
}

TEST(MeshGrid, OfAWideMeshTheSquareAroundThePlaceIsSampled) {
  const Terrain mesh = SlopeAt(0.0F, 100e3F);
  const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 65);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->columns, 65);
  EXPECT_EQ(grid->rows, 65);
  EXPECT_EQ(ShareOnMesh(*grid), 1.0);
  const double width_m = 64 * grid->step_lat_rad * 6.37e6;
  EXPECT_NEAR(width_m, 80e3, 500.0);
  EXPECT_NEAR(grid->north_rad - kPlace.latitude_rad, 32 * grid->step_lat_rad, 1e-9);
}

TEST(MeshGrid, AtTheEdgeOfAWideMeshTheSquareLiesOnIt) {
  const Terrain mesh = SlopeAt(150e3F, 100e3F);  // from 50 km to 250 km east
  const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 65);
  ASSERT_TRUE(grid);
  EXPECT_GT(ShareOnMesh(*grid), 0.95);
  EXPECT_LT(grid->west_rad - kPlace.longitude_rad, 50e3 / 6.37e6 / std::cos(kPlace.latitude_rad))
      << "as near to the place as the mesh comes";
}

TEST(MeshGrid, TheHighestSurfaceCounts) {
  TriangleMesh two = SlopeAt(0.0F, 50.0F).mesh();
  for (std::size_t i = 0; i < 4; ++i)
    two.positions.push_back({two.positions[i][0], two.positions[i][1], 130.0F});
  two.normals.assign(8, {0.0F, 0.0F, 1.0F});
  two.triangles.push_back({4, 5, 6});
  two.triangles.push_back({4, 6, 7});
  const auto grid = GridOverMesh(Terrain(std::move(two)), kFrame, kPlace, 40e3, 32);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(*grid->HeightAt(kPlace.latitude_rad, kPlace.longitude_rad), 130.0, 1e-3);
}

}  // namespace
}  // namespace alpenglow::viewer
