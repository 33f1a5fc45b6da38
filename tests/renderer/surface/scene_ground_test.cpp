// SPDX-License-Identifier: MIT
#include "renderer/surface/scene_ground.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/obj_texts.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Latitudes 46 to 47, longitudes 8 to 9, everything 500 m high.
class AModel : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    const std::string high("\x01\xf4");  // big endian
    std::ofstream file(File(), std::ios::binary);
    for (int sample = 0; sample < 1201 * 1201; ++sample) file << high;
  }

  [[nodiscard]] std::filesystem::path File() const { return folder_ / "N46E008.hgt"; }
  [[nodiscard]] Scene At(double latitude, double longitude) const {
    SceneOptions options;
    options.dem = {File().string()};
    options.latitude = latitude;
    options.longitude = longitude;
    return SceneFromOptions(options);
  }
  [[nodiscard]] static std::string FaultOf(const Scene& scene) {
    try {
      static_cast<void>(LoadGround(scene));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

TEST_F(AModel, RefusesAnEyeThatStandsOutsideAndNamesItsPlaceAndTheModels) {
  const std::string fault = FaultOf(At(45.5, 8.5));
  EXPECT_THAT(fault, HasSubstr("latitude 45.5, longitude 8.5"));
  EXPECT_THAT(fault, HasSubstr("N46E008.hgt"));
  EXPECT_THAT(fault, HasSubstr("latitudes 46 to 47 and longitudes 8 to 9"));
  EXPECT_THAT(fault, Not(HasSubstr("swapped")));
  EXPECT_THAT(FaultOf(At(47.0000001, 8.5)), HasSubstr("latitude 47.0000001, "))
      << "as many digits as tell it from 47";
  EXPECT_THAT(FaultOf(At(8.5, 46.5)), HasSubstr("latitude and longitude seem to be swapped"));
}

TEST_F(AModel, IsSeenFromOutsideByAnEyeHighEnough) {
  // From 1 km one sees 113 km far, and the model's 500 m stick out from 80 km farther.
  Scene scene = At(45.0, 8.5);
  scene.camera.height = {1000.0, false};
  EXPECT_EQ(FaultOf(scene), "") << "111 km away";
  scene = At(44.0, 8.5);
  scene.camera.height = {1000.0, false};
  EXPECT_THAT(FaultOf(scene), HasSubstr("is outside")) << "222 km away";
  scene.camera.height = {4e5, false};
  EXPECT_EQ(FaultOf(scene), "") << "from space";
}

TEST_F(AModel, IsWhatAnEyeInsideStandsOnWithoutAWord) {
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

void ExpectWindow(const GridWindow& window, const std::array<int, 4>& expected) {
  EXPECT_EQ(window.first_column, expected[0]);
  EXPECT_EQ(window.first_row, expected[1]);
  EXPECT_EQ(window.columns, expected[2]);
  EXPECT_EQ(window.rows, expected[3]);
}

TEST(WindowAround, HoldsWhatLiesWithinADistance) {
  const ElevationGrid grid = Earth(360);  // samples at half degrees
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(0.5, 10.5, 0.0), 2.2 * kRadiansPerDegree),
               {187, 86, 7, 7});
  // At 60 degrees a degree of longitude is half as long.
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(60.5, 10.5, 0.0), 2.2 * kRadiansPerDegree),
               {185, 26, 11, 7});
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(0.5, 179.5, 0.0), 1.2 * kRadiansPerDegree),
               {357, 87, 5, 5});
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(0.5, -179.5, 0.0), 1.2 * kRadiansPerDegree),
               {358, 87, 5, 5});
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(89.0, 10.5, 0.0), 2.2 * kRadiansPerDegree),
               {0, 0, 360, 4});
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(0.3, 10.7, 0.0), 0.0), {190, 89, 2, 2});
}

TEST(WindowAround, StaysInTheGridOfAPlaceBesideIt) {
  ElevationGrid grid = Earth(360);
  grid.columns = 20;  // from -179.5 to -160.5
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(0.5, 175.5, 0.0), 1.2 * kRadiansPerDegree),
               {0, 87, 2, 5});
  ExpectWindow(WindowAround(grid, PlaceFromDegrees(0.5, -150.5, 0.0), 1.2 * kRadiansPerDegree),
               {18, 87, 2, 5});
}

// The model has the size of GEBCO's older grid, of a minute: its samples fit into memory, its triangles
// do not.
TEST_F(AModel, OfTheWholeEarthIsReadAroundTheCamera) {
  GDALRegister_GTiff();
  const std::filesystem::path file = folder_ / "earth.tif";
  const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", nullptr};
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), 21600, 10800, 1, GDT_Int16, const_cast<char**>(options));
  std::array<double, 6> transform{-180.0, 1.0 / 60.0, 0.0, 90.0, 0.0, -1.0 / 60.0};
  dataset->SetGeoTransform(transform.data());
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  dataset->SetSpatialRef(&crs);
  std::vector<float> heights(128 * 128, 500.0F);
  ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 11216, 2546, 128, 128, heights.data(),
                                                128, 128, GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  Scene scene = At(46.5, 8.0);
  scene.terrain.file = file;
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
  [[nodiscard]] Scene SceneOn(const std::string& obj, const Height& eye) const {
    WriteText(folder_ / "m.obj", obj);
    Scene scene = BareScene(0.0, 0.0, 0.0, 60.0);
    scene.camera.height = eye;
    scene.terrain.kind = TerrainSource::Kind::kMesh;
    scene.terrain.file = folder_ / "m.obj";
    return scene;
  }
};

TEST_F(AMesh, HoldsAnEyeBetweenARoofAndTheGround) {
  EXPECT_EQ(LoadGround(SceneOn(tests::RoofObj(), {25.0, false})).eye_height_m, 25.0);
  EXPECT_EQ(LoadGround(SceneOn(tests::RoofObj(), {34.9, false})).eye_height_m, 34.9);
  EXPECT_NEAR(LoadGround(SceneOn(tests::RoofObj(), {2.0, true})).eye_height_m, 37.0, 1e-6)
      << "over the ground is over the roof";
  EXPECT_THAT(tests::FaultOf([&] {
                return LoadGround(SceneOn(tests::RoofObj(), {19.0, false}));
              }),
              HasSubstr("camera.height_m is 19.0; the ground there is at 20.0 m"));
}

TEST_F(AMesh, HoldsACameraOfAPathBetweenARoofAndTheGround) {
  const SceneGround ground = LoadGround(SceneOn(tests::RoofObj(), {25.0, false}));
  const auto eye_at = [&](double height_m) {
    return StandAt(ground, PlaceFromDegrees(46.5001, 8.0001, height_m)).eye.z;
  };
  EXPECT_NEAR(eye_at(25.0), 25.0, 0.01);
  EXPECT_THAT(tests::FaultOf([&] { return eye_at(19.0); }),
              HasSubstr("the ground there is at 20.0 m"));
  EXPECT_NEAR(GroundHeightUnder(ground, PlaceFromDegrees(46.5, 8.0, 25.0)), 35.0, 1e-6);
}

TEST_F(AMesh, HoldsALampBetweenARoofAndTheGround) {
  Scene scene = SceneOn(tests::RoofObj(), {40.0, false});
  const SceneGround ground = LoadGround(scene);
  const LampStage stage(scene, ground, scene.medium);
  const auto lamp_at = [&](const Height& height) {
    Light light;
    light.latitude_rad = scene.place.latitude_rad;
    light.longitude_rad = scene.place.longitude_rad;
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

TEST_F(AMesh, TellsAllThatIsToBeSaidInOneLine) {
  const std::string message =
      LoadGround(SceneOn(tests::RoofObj() + "f 1 1 2\n", {25.0, false})).message;
  EXPECT_THAT(message, HasSubstr("1 face without area left out (the first in line 11)"));
  EXPECT_THAT(message, HasSubstr("the mesh has overhangs"));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

TEST_F(AMesh, IsTurnedUpWhereItsYAxisIsUp) {
  // A wall in the file's own axes, 50 m over the place when its y axis is up.
  Scene scene = SceneOn("v -9 50 9\nv 9 50 9\nv 9 50 -9\nv -9 50 -9\nf 1 2 3 4\n", {1.0, true});
  scene.terrain.up = UpAxis::kY;
  EXPECT_NEAR(LoadGround(scene).eye_height_m, 51.0, 1e-6);
}

TEST(SceneGround, TellsThatTerrainIsMadeUp) {
  SceneOptions options;
  options.latitude = 47.0;
  options.longitude = 11.0;
  EXPECT_THAT(LoadGround(SceneFromOptions(options)).message, HasSubstr("made up"));
}

}  // namespace
}  // namespace alpenglow::renderer
