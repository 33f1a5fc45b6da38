// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/scene.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "renderer/picture/render.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

const StillOptions kSmall{
    .width = 16, .height = 9, .noise = std::nullopt, .samples_per_pixel = 2, .layers = {"depth"}};

SceneDescription Sea() {
  SceneDescription sea;
  sea.place = {46.5, 8.0};
  sea.camera = {.height_m = 300.0, .height_is_above_ground = false, .pitch_deg = -5.0};
  sea.terrain = TerrainKind::kNone;
  return sea;
}

class ApiScene : public TemporaryFolder {};

TEST_F(ApiScene, IsRenderedAsByTheLayerBelow) {
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  const Scene sea(Sea());
  const HdrImage still = sea.Render(time, kSmall);
  renderer::Scene scene;
  scene.place = {46.5, 8.0, 0.0};
  scene.camera = renderer::CameraFromDegrees({300.0, false}, 0.0, -5.0, 0.0, 60.0);
  scene.medium = atmosphere::MediumPreset("earth");
  scene.terrain.kind = renderer::TerrainSource::Kind::kNone;
  renderer::RenderSettings settings;
  settings.width = 16;
  settings.height = 9;
  settings.samples_per_pixel = 2;
  settings.layers = {renderer::PictureLayer::kDepth};
  const renderer::SceneRenderer expected(scene);
  const auto instant = atmosphere::ParseInstant("2026-06-21T16:00:00Z");
  const HdrImage image = expected.Render(instant, settings);
  EXPECT_EQ(still.rgb, image.rgb);
  ASSERT_EQ(still.layers.size(), 1U);
  EXPECT_EQ(still.layers[0].values, image.layers[0].values);
  EXPECT_EQ(sea.HorizontalIlluminance(time), expected.Illuminance(instant));
  EXPECT_EQ(still.metadata.at("alpenglow.utc"), "2026-06-21T16:00:00Z");

  WriteText(folder_ / "sea.toml",
            "[place]\nlatitude = 46.5\nlongitude = 8.0\n[camera]\nheight_m = 300.0\n"
            "pitch = -5.0\n[terrain]\nnone = true\n");
  EXPECT_EQ(Scene::Read(folder_ / "sea.toml").Render(time, kSmall).rgb, image.rgb);
}

TEST_F(ApiScene, WrongInputIsRefused) {
  SceneDescription sea = Sea();
  sea.camera.pitch_deg = 91.0;
  EXPECT_THROW((void)Scene(sea), InputError);
  sea = Sea();
  sea.terrain = TerrainKind::kElevationModel;
  sea.elevation_model = folder_ / "none.tif";
  EXPECT_THROW((void)Scene(sea), InputError);
  EXPECT_THROW((void)Scene::Read(folder_ / "none.toml"), InputError);
}

TEST_F(ApiScene, ARenderedSceneNeedsItsFilesNoMore) {
  WriteText(folder_ / "flat.obj", "v -900 -900 0\nv 900 -900 0\nv 0 900 0\nf 1 2 3\n");
  WriteText(folder_ / "flat.toml",
            "[place]\nlatitude = 46.5\nlongitude = 8.0\n[camera]\nheight_m = 300.0\n"
            "[terrain]\nmesh = \"flat.obj\"\n");
  const Scene scene = Scene::Read(folder_ / "flat.toml");
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  const HdrImage first = scene.Render(time, kSmall);
  EXPECT_NE(first.metadata.at("alpenglow.terrain").find("flat.obj, hash "), std::string::npos);
  WriteText(folder_ / "flat.obj", "something else");
  EXPECT_EQ(scene.Render(time, kSmall).metadata, first.metadata) << "the file that was loaded";
  std::filesystem::remove(folder_ / "flat.obj");
  EXPECT_EQ(scene.Render(time, kSmall).metadata, first.metadata);
}

TEST_F(ApiScene, ValuesThatCannotBeAreRefused) {
  SceneDescription sea = Sea();
  sea.terrain = static_cast<TerrainKind>(7);
  EXPECT_THROW((void)Scene(sea), InputError);
  sea = Sea();
  sea.place.latitude_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)Scene(sea), InputError);
  sea = Sea();
  sea.atmosphere = Atmosphere::FromToml(
      "[spectrum]\nwavelengths_nm = [200, 210]\nsolar_irradiance = [0.01, 0.01]\n"
      "[rayleigh]\nscattering_per_m = [9e-4, 7e-4]\n[mie]\nscattering_per_m = [1e-5, 1e-5]\n"
      "extinction_per_m = [1e-5, 1e-5]\n[ozone]\nabsorption_per_m = [0, 0]\n"
      "[planet]\nground_albedo = [0.1, 0.1]\n");
  EXPECT_THROW((void)Scene(sea), InputError) << "no colours";
  const Scene scene(Sea());
  const UtcTime year_20000{std::chrono::sys_days(std::chrono::year(20000) / 1 / 1)};
  EXPECT_THROW((void)scene.Render(year_20000, kSmall), InputError);
  EXPECT_THROW((void)scene.HorizontalIlluminance(year_20000), InputError);
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  for (const double noise : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    StillOptions options = kSmall;
    options.noise = noise;
    EXPECT_THROW((void)scene.Render(time, options), InputError) << noise;
  }
  for (int StillOptions::*number :
       {&StillOptions::width, &StillOptions::height, &StillOptions::samples_per_pixel}) {
    for (const int value : {-1, 0, 1 << 20}) {
      StillOptions options = kSmall;
      options.*number = value;
      EXPECT_THROW((void)scene.Render(time, options), InputError) << value;
    }
  }
}

TEST(BuiltInScene, LooksAtTheMountainsFromTheGround) {
  const SceneDescription scene = BuiltInScene();
  EXPECT_EQ(scene.terrain, TerrainKind::kBuiltInMountains);
  EXPECT_TRUE(scene.camera.height_is_above_ground);
  EXPECT_NEAR(scene.place.latitude_deg, 46.5, 1.0);
}

}  // namespace
}  // namespace alpenglow
