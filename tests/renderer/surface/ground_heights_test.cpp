// SPDX-License-Identifier: MIT
#include "renderer/surface/scene_ground.h"

#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

/// Level squares around the origin of the frame, of a half width at a height.
struct Square {
  float half_m, z_m;
};

Terrain TerrainOf(const std::vector<Square>& squares) {
  TriangleMesh mesh;
  for (const auto& [half, z] : squares) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  mesh.normals.assign(mesh.positions.size(), {0.0F, 0.0F, 1.0F});
  return Terrain(std::move(mesh));
}

const GeodeticPosition kPlace = PlaceFromDegrees(46.5, 8.0, 0.0);
const LocalFrame kFrame(kWgs84, kPlace);

TEST(GroundHeights, UnderARoofTheGroundHasTwoHeights) {
  const Terrain town = TerrainOf({{1000.0F, 20.0F}, {50.0F, 35.0F}, {50.0F, 34.5F}});
  GeodeticPosition between = kPlace;
  for (const double height_m : {-100.0, 25.0, 40.0, 9000.0}) {
    between.height_m = height_m;
    const auto ground = GroundHeightsAt(town, kFrame, between);
    ASSERT_TRUE(ground);
    EXPECT_NEAR(ground->lowest_m, 20.0, 1e-3) << "whatever the height that is asked from";
    EXPECT_NEAR(ground->highest_m, 35.0, 1e-3);
  }
}

TEST(GroundHeights, BesideARoofTheyAreOneAndBesideAllNothing) {
  const Terrain town = TerrainOf({{1000.0F, 20.0F}, {50.0F, 35.0F}});
  const auto beside = GroundHeightsAt(town, kFrame, kFrame.GeodeticFromEnu({{300.0, 100.0, 0.0}}));
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->lowest_m, beside->highest_m);
  EXPECT_FALSE(GroundHeightsAt(town, kFrame, kFrame.GeodeticFromEnu({{0.0, 3000.0, 0.0}})));
}

TEST(GroundHeights, FarFromTheOriginTheyAreAlongTheVerticalThere) {
  const Terrain plate = TerrainOf({{200e3F, 0.0F}});
  const GeodeticPosition far = kFrame.GeodeticFromEnu({{150e3, 0.0, 0.0}});
  const auto ground = GroundHeightsAt(plate, kFrame, far);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->highest_m, far.height_m, 1.0) << "the ellipsoid curves away under a plane";
  EXPECT_GT(far.height_m, 1700.0);
}

TEST(GroundHeights, AlongAVerticalTheyAreOverThePoint) {
  const Terrain town = TerrainOf({{1000.0F, 20.0F}, {50.0F, 35.0F}});
  const auto ground = GroundHeightsAlong(town, {10.0, 5.0, 28.0}, {0.0, 0.0, 1.0});
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->lowest_m, -8.0, 1e-4);
  EXPECT_NEAR(ground->highest_m, 7.0, 1e-4);
}

}  // namespace
}  // namespace alpenglow::renderer
