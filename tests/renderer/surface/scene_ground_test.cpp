// SPDX-License-Identifier: MIT
// The ground of a scene under eyes and lamps: elevation models, meshes with roofs, the built-in
// range.
#include "renderer/surface/scene_ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/mesh_scene.h"
#include "tests/fixtures/obj_texts.h"
#include "tests/fixtures/raster_file.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using testing::Not;

// An elevation model of latitudes 46 to 47 and longitudes 8 to 9, in which everything is 500 m
// high.
class AModel : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    constexpr double kStep = 1.0 / 60.0;
    tests::Raster raster;
    raster.columns = raster.rows = 61;
    raster.geotransform = {8.0 - 0.5 * kStep, kStep, 0.0, 47.0 + 0.5 * kStep, 0.0, -kStep};
    raster.height = [](int, int) { return 500.0F; };
    file_ = tests::WriteRaster(folder_, raster);
  }
  [[nodiscard]] Scene At(double latitude, double longitude,
                         const Height& height = {2.0, true}) const {
    SceneOptions options;
    options.dem = {file_.string()};
    options.latitude = latitude;
    options.longitude = longitude;
    Scene scene = SceneFromOptions(options);
    scene.camera.height = height;
    return scene;
  }
  [[nodiscard]] static std::string FaultOf(const Scene& scene) {
    return tests::FaultOf([&] { return LoadGround(scene); });
  }

  std::filesystem::path file_;
};

TEST_F(AModel, RefusesAnEyeOutsideAndNamesBothPlaces) {
  const std::string fault = FaultOf(At(45.5, 8.5));
  EXPECT_THAT(fault, HasSubstr("latitude 45.5, longitude 8.5"));
  EXPECT_THAT(fault, HasSubstr("dem.tif"));
  EXPECT_THAT(fault, HasSubstr("latitudes 46 to 47 and longitudes 8 to 9"));
  EXPECT_THAT(fault, Not(HasSubstr("swapped")));
  EXPECT_THAT(FaultOf(At(47.0000001, 8.5)), HasSubstr("latitude 47.0000001, "))
      << "as many digits as tell it from 47";
  EXPECT_THAT(FaultOf(At(8.5, 46.5)), HasSubstr("latitude and longitude seem to be swapped"));
}

TEST_F(AModel, IsSeenFromOutsideByAnEyeHighEnough) {
  // From 1 km the horizon is 113 km away, and 500 m are visible from 80 km farther.
  EXPECT_EQ(FaultOf(At(45.0, 8.5, {1000.0, false})), "no fault") << "111 km away";
  EXPECT_THAT(FaultOf(At(44.0, 8.5, {1000.0, false})), HasSubstr("is outside")) << "222 km away";
  EXPECT_EQ(FaultOf(At(44.0, 8.5, {4e5, false})), "no fault") << "from space";
}

TEST_F(AModel, CarriesAnEyeInsideWithoutAMessage) {
  const SceneGround ground = LoadGround(At(46.5, 8.5));
  EXPECT_NEAR(ground.eye_height_m, 502.0, 0.1) << "a facet sags by less";
  EXPECT_EQ(ground.message, "");
}

ElevationGrid Earth(int columns) {
  ElevationGrid grid;
  grid.columns = columns;
  grid.rows = columns / 2;
  grid.step_lon_rad = grid.step_lat_rad = 2.0 * kPi / columns;
  grid.west_rad = -kPi + 0.5 * grid.step_lon_rad;
  grid.north_rad = 0.5 * kPi - 0.5 * grid.step_lat_rad;
  return grid;
}

void ExpectWindow(const ElevationGrid& grid, double latitude, double longitude, double reach_deg,
                  const std::array<int, 4>& expected) {
  const GridWindow window =
      WindowAround(grid, CheckedPlace({latitude, longitude, 0.0}), reach_deg * kRadiansPerDegree);
  EXPECT_EQ((std::array{window.first_column, window.first_row, window.columns, window.rows}),
            expected)
      << latitude << " " << longitude;
}

TEST(WindowAround, ContainsEverythingWithinADistance) {
  const ElevationGrid grid = Earth(360);  // samples at half degrees
  struct Case {
    double latitude, longitude, reach_deg;
    std::array<int, 4> window;  // first column, first row, columns, rows
  };
  for (const Case& one : {Case{0.5, 10.5, 2.2, {187, 86, 7, 7}},
                          {60.5, 10.5, 2.2, {185, 26, 11, 7}},  // a degree is half as long
                          {0.5, 179.5, 1.2, {357, 87, 5, 5}},
                          {0.5, -179.5, 1.2, {358, 87, 5, 5}},
                          {89.0, 10.5, 2.2, {0, 0, 360, 4}},
                          {0.3, 10.7, 0.0, {190, 89, 2, 2}}})
    ExpectWindow(grid, one.latitude, one.longitude, one.reach_deg, one.window);
  ElevationGrid part = grid;
  part.columns = 20;                                   // from -179.5 to -160.5
  ExpectWindow(part, 0.5, 175.5, 1.2, {0, 87, 2, 5});  // places beside the grid
  ExpectWindow(part, 0.5, -150.5, 1.2, {18, 87, 2, 5});
}

// The model has the size of GEBCO's older grid, of a minute: its samples fit into memory, its
// triangles do not.
TEST_F(AModel, OfTheWholeEarthIsReadAroundTheCamera) {
  tests::Raster earth;
  earth.name = "earth.tif";
  earth.columns = 21600;
  earth.rows = 10800;
  earth.type = GDT_Int16;
  earth.geotransform = {-180.0, 1.0 / 60.0, 0.0, 90.0, 0.0, -1.0 / 60.0};
  earth.window = {11216, 2546, 128, 128};
  earth.height = [](int, int) { return 500.0F; };
  Scene scene = At(46.5, 8.0);
  scene.terrain.file = tests::WriteRaster(folder_, earth);
  const ModelInSight seen = ReadModelInSight(scene);
  EXPECT_EQ(seen.extent.columns, 21600);
  EXPECT_LT(seen.model.grid.height_m.size(), 500000U);
  EXPECT_GT(seen.model.grid.height_m.size(), 200000U) << "460 km around an eye at 502 m";
  EXPECT_NEAR(*seen.model.grid.HeightAt(46.5 * kRadiansPerDegree, 8.0 * kRadiansPerDegree), 500.0,
              1e-3);
  EXPECT_THAT(seen.message, HasSubstr("of 21600 x 10800 samples"));
  EXPECT_THAT(seen.message, HasSubstr("km of the camera"));
}

class AMesh : public TemporaryFolder {
 protected:
  [[nodiscard]] Scene SceneOn(const std::string& obj, double height_m,
                              bool above_ground = false) const {
    Scene scene = tests::MeshScene(BareScene(0.0, 0.0, 0.0, 60.0), folder_ / "m.obj", obj);
    scene.camera.height = {height_m, above_ground};
    return scene;
  }
};

TEST_F(AMesh, HoldsEyesBetweenARoofAndTheGround) {
  const auto eye_at = [&](double height_m, bool above_ground = false) {
    return LoadGround(SceneOn(tests::RoofObj(), height_m, above_ground)).eye_height_m;
  };
  EXPECT_EQ(eye_at(25.0), 25.0);
  EXPECT_EQ(eye_at(34.9), 34.9);
  EXPECT_NEAR(eye_at(2.0, true), 37.0, 1e-6) << "over the ground is over the roof";
  EXPECT_THAT(tests::FaultOf([&] { return eye_at(19.0); }),
              HasSubstr("camera.height_m is 19.0; the ground there is at 20.0 m"));
  const SceneGround ground = LoadGround(SceneOn(tests::RoofObj(), 25.0));
  const auto on_path_at = [&](double height_m) {
    return FromEyeAt(ground, Place{46.5001, 8.0001, height_m}).origin_m().z;
  };
  EXPECT_NEAR(on_path_at(25.0), 25.0, 0.01);
  EXPECT_THAT(tests::FaultOf([&] { return on_path_at(19.0); }),
              HasSubstr("the ground there is at 20.0 m"));
  EXPECT_NEAR(GroundHeightUnder(ground, Place{46.5, 8.0, 25.0}), 35.0, 1e-6);
}

TEST_F(AMesh, HoldsALampBetweenARoofAndTheGround) {
  Scene scene = SceneOn(tests::RoofObj(), 40.0);
  const SceneGround ground = LoadGround(scene);
  const LampStage stage(scene, ground, scene.medium);
  const auto lamp_at = [&](const Height& height) {
    Light light;
    light.place = scene.place;
    light.height = height;
    light.intensity_cd = 5000.0;
    scene.lights = {light};
    return PlacedLampsOf(scene, stage, scene.medium, BandColour(scene.medium.wavelengths_nm)).at(0);
  };
  const PlacedLamp under = lamp_at({28.0, false});
  EXPECT_NEAR(under.lamp.position_m.z, 28.0, 1e-6);
  EXPECT_NEAR(under.above_ground_m, 8.0, 1e-4) << "it shines on the floor";
  EXPECT_NEAR(lamp_at({36.0, false}).above_ground_m, 1.0, 1e-4) << "it shines on the roof";
  EXPECT_NEAR(lamp_at({2.0, true}).lamp.position_m.z, 37.0, 1e-4);
  EXPECT_THAT(tests::FaultOf([&] {
                return lamp_at({19.0, false});
              }),
              HasSubstr("light 1: height_m is 19; the ground there is at 20.0 m"));
}

TEST_F(AMesh, ReportsItsFaultsInOneLine) {
  const std::string message = LoadGround(SceneOn(tests::RoofObj() + "f 1 1 2\n", 25.0)).message;
  EXPECT_THAT(message, HasSubstr("1 face without area left out (the first in line 11)"));
  EXPECT_THAT(message, HasSubstr("the mesh has overhangs"));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

TEST_F(AMesh, IsTurnedUprightIfItsYAxisIsUp) {
  // The square is a wall in the file's own axes, and 50 m over the place when its y axis is up.
  Scene scene = SceneOn("v -9 50 9\nv 9 50 9\nv 9 50 -9\nv -9 50 -9\nf 1 2 3 4\n", 1.0, true);
  scene.terrain.up = UpAxis::kY;
  EXPECT_NEAR(LoadGround(scene).eye_height_m, 51.0, 1e-6);
}

/// A level square around the origin of the frame.
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

const Place kTownPlace{46.5, 8.0, 0.0};
const LocalFrame kFrame(kWgs84, kTownPlace);

TEST(GroundHeights, GroundUnderARoofHasTwoHeights) {
  const Terrain town = TerrainOf({{1000.0F, 20.0F}, {50.0F, 35.0F}, {50.0F, 34.5F}});
  Place between = kTownPlace;
  for (const double height_m : {-100.0, 25.0, 40.0, 9000.0}) {
    between.height_m = height_m;
    const auto ground = GroundHeightsAt(town, kFrame, between);
    ASSERT_TRUE(ground);
    EXPECT_NEAR(ground->lowest_m, 20.0, 1e-3) << "whatever the height that is asked from";
    EXPECT_NEAR(ground->highest_m, 35.0, 1e-3);
  }
}

TEST(GroundHeights, AreOneBesideARoofAndNoneOutsideTheMesh) {
  const Terrain town = TerrainOf({{1000.0F, 20.0F}, {50.0F, 35.0F}});
  const auto beside = GroundHeightsAt(town, kFrame, kFrame.GeodeticFromEnu({{300.0, 100.0, 0.0}}));
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->lowest_m, beside->highest_m);
  EXPECT_FALSE(GroundHeightsAt(town, kFrame, kFrame.GeodeticFromEnu({{0.0, 3000.0, 0.0}})));
}

TEST(GroundHeights, AreAlongTheLocalVertical) {
  const Terrain plate = TerrainOf({{200e3F, 0.0F}});
  const Place far = kFrame.GeodeticFromEnu({{150e3, 0.0, 0.0}});
  const auto ground = GroundHeightsAt(plate, kFrame, far);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->highest_m, far.height_m, 1.0) << "the ellipsoid curves away under a plane";
  EXPECT_GT(far.height_m, 1700.0);
}

TEST(GroundHeights, AlongAVerticalAreRelativeToThePoint) {
  const Terrain town = TerrainOf({{1000.0F, 20.0F}, {50.0F, 35.0F}});
  const auto ground = GroundHeightsAlong(town, {10.0, 5.0, 28.0}, {0.0, 0.0, 1.0});
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->lowest_m, -8.0, 1e-4);
  EXPECT_NEAR(ground->highest_m, 7.0, 1e-4);
}

TEST_F(AModel, CloudsWithTheirBaseBelowAllGroundAreRefused) {
  Scene scene = At(46.5, 8.5);
  scene.clouds.resize(1);
  scene.clouds[0].name = "s.toml: cloud[0]";
  scene.clouds[0].options.base_altitude_m = 501.0;
  EXPECT_EQ(FaultOf(scene), "no fault");
  scene.clouds[0].options.base_altitude_m = 499.0;
  EXPECT_THAT(FaultOf(scene), HasSubstr("s.toml: cloud[0].base_height_m is 499; the lowest ground "
                                        "of the scene is at 500.0 m"));
}

}  // namespace
}  // namespace alpenglow::renderer
