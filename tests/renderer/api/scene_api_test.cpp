// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/scene.h>
#include <alpenglow/sky.h>
#include <alpenglow/sun_and_moon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "renderer/picture/render.h"
#include "tests/fixtures/comma_locale.h"
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

/// A hill of a kilometre, which is not symmetric.
const char* const kHill =
    "v -9000 -9000 0\nv 9000 -9000 0\nv 9000 9000 100\nv -9000 9000 0\nv 500 3000 1000\n"
    "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

std::string HillFrom(double height_m, double heading_deg) {
  return "[place]\nlatitude = 46.5\nlongitude = 8.0\n[camera]\nheight_m = " +
         std::to_string(height_m) + "\nheading = " + std::to_string(heading_deg) +
         "\n[terrain]\nmesh = \"hill.obj\"\n";
}

/// Returns the largest relative difference of the green channels.
double LargestDifference(const HdrImage& a, const HdrImage& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double one = double{a.rgb[i][1]}, other = double{b.rgb[i][1]};
    largest = std::max(largest, std::abs(one - other) / std::max(one, other));
  }
  return largest;
}

// The picture of another view equals that of a scene that is loaded with this view. Rays differ in
// the last digits of their coordinates, which moves an edge of the hill by much less than a pixel.
TEST_F(ApiScene, ViewsAreThoseOfScenesLoadedWithThem) {
  WriteText(folder_ / "hill.obj", kHill);
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  const Scene scene = Scene::FromToml(HillFrom(1500.0, 90.0), folder_);
  View view = scene.view();
  EXPECT_EQ(view.camera.heading_deg, 90.0);
  EXPECT_EQ(scene.Render(view, time, kSmall).rgb, scene.Render(time, kSmall).rgb);
  view.camera.heading_deg = 10.0;
  view.camera.height_m = 2000.0;
  const HdrImage seen = scene.Render(view, time, kSmall);
  const Scene other = Scene::FromToml(HillFrom(2000.0, 10.0), folder_);
  EXPECT_LT(LargestDifference(seen, other.Render(time, kSmall)), 1e-3);
  EXPECT_GT(LargestDifference(seen, scene.Render(time, kSmall)), 0.1) << "another picture";
  EXPECT_NEAR(scene.HorizontalIlluminance(view, time) / other.HorizontalIlluminance(time), 1.0,
              1e-6);
  EXPECT_EQ(seen.metadata.at("alpenglow.heading_deg"), "10");
  EXPECT_EQ(scene.Render(time, kSmall).metadata.at("alpenglow.heading_deg"), "90");
}

TEST_F(ApiScene, HeightsOfViewsCountFromTheGroundBelowThem) {
  WriteText(folder_ / "hill.obj", kHill);
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  const Scene scene = Scene::FromToml(HillFrom(1500.0, 90.0), folder_);
  View view = scene.view();
  view.place.latitude_deg += 3000.0 / 111.2e3;  // near the top
  view.place.longitude_deg += 500.0 / 76.6e3;
  view.camera = {.height_m = 50.0, .pitch_deg = -90.0, .fov_deg = 1.0};
  const HdrImage down = scene.Render(view, time, kSmall);
  EXPECT_NEAR(double{down.layers.at(0).values.at(72)}, 50.0, 0.1) << "the depth in the middle";
  view.camera = {.height_m = 900.0, .height_is_above_ground = false};
  EXPECT_THROW((void)scene.Render(view, time, kSmall), InputError) << "under the top";
  EXPECT_THROW((void)scene.HorizontalIlluminance(view, time), InputError);
  view = {.place = {0.0, 8.0}, .camera = {}};
  EXPECT_THROW((void)scene.Render(view, time, kSmall), InputError) << "5000 km away";
  view = scene.view();
  view.camera.pitch_deg = 91.0;
  EXPECT_THROW((void)scene.Render(view, time, kSmall), InputError);
  view = scene.view();
  view.place.latitude_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)scene.Render(view, time, kSmall), InputError);
}

TEST_F(ApiScene, AViewOfAllDirectionsIsAPanorama) {
  View view = Scene(Sea()).view();
  view.camera.fov_deg = 360.0;
  EXPECT_TRUE(Scene(Sea()).Render(view, TimeFromText("2026-06-21T16:00:00Z"), kSmall).is_panorama);
}

TEST_F(ApiScene, PicturesTellTheirProgressAndEndWhenTheyAreCancelled) {
  const Scene sea(Sea());
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  for (const std::optional<double> noise : {std::optional<double>(), std::optional(0.5)}) {
    StillOptions options = kSmall;
    options.noise = noise;
    std::vector<double> fractions;
    const auto note = [&](double fraction) {
      fractions.push_back(fraction);
      return true;
    };
    EXPECT_EQ(sea.Render(time, options, note).rgb, sea.Render(time, options).rgb);
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_EQ(fractions.back(), 1.0);
    int calls = 0;
    const auto cancel = [&](double) { return ++calls > 5; };
    EXPECT_THROW((void)sea.Render(time, options, cancel), Cancelled);
    EXPECT_EQ(calls, 1) << "no call follows the one that cancels";
  }
}

TEST_F(ApiScene, OnOneThreadEverythingRunsOnTheCallers) {
  const Scene sea(Sea());
  const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
  std::set<std::thread::id> threads;
  const auto note = [&](double) { return threads.insert(std::this_thread::get_id()), true; };
  HdrImage still;
  OnThreads(1, [&] { still = sea.Render(time, kSmall, note); });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
  EXPECT_EQ(still.rgb, sea.Render(time, kSmall).rgb);
  EXPECT_THROW(OnThreads(0, [] {}), InputError);
  EXPECT_THROW(OnThreads(2, [] { throw OutputError("full"); }), OutputError);
}

// A full moon high in the sky gives a fifth of a lux. The illuminance of the scene has the airglow
// and the stars too, less than a hundredth of it.
TEST_F(ApiScene, MoonlightIsThatOfTheLibraryOfTheSky) {
  const Scene sea(Sea());
  const UtcTime midnight = TimeFromText("2026-12-24T00:00:00Z");
  const Place eye{46.5, 8.0, 300.0};
  const Atmosphere air = Atmosphere().AtLatitude(eye.latitude_deg);
  const MoonInSky moon = MoonAt(eye, midnight, air);
  EXPECT_GT(moon.elevation_deg, 60.0);
  const Sky sky(air);
  Sunlight light = moon.ToMoon();
  light.to_sun_for_air = moon.ToMoonForAir();
  const LocalPoint point{.up_m = eye.height_m};
  const Spectrum lit = MoonIrradiance(moon, air) *
                       (sky.SunIrradiance(point, light) + sky.SkyIrradiance(point, light));
  const double moonlight_lx = Luminance(air.ColourOf(lit));
  EXPECT_GT(moonlight_lx, 0.15);
  EXPECT_LT(moonlight_lx, 0.35);
  EXPECT_NEAR(moonlight_lx / sea.HorizontalIlluminance(midnight), 1.0, 0.01);
  MoonInSky none = moon;
  none.phase_angle_deg = 181.0;
  EXPECT_THROW((void)MoonIrradiance(none, air), InputError);
}

TEST_F(ApiScene, TextsAndNumbersDoNotFollowTheLocale) {
  WriteText(folder_ / "hill.obj", kHill);
  const std::string air = Atmosphere().ToToml();
  const std::string text = HillFrom(1500.25, 10.5);
  const UtcTime time = TimeFromText("2026-06-21T16:00:00.5Z");
  const HdrImage plain = Scene::FromToml(text, folder_).Render(time, kSmall);
  const tests::CommaLocale locale(folder_);
  EXPECT_EQ(Atmosphere::FromToml(air).ToToml(), air);
  EXPECT_EQ(TimeFromText("2026-06-21T16:00:00.5Z"), time);
  const Scene scene = Scene::FromToml(text, folder_);
  EXPECT_EQ(scene.view().camera.height_m, 1500.25);
  EXPECT_EQ(scene.Render(time, kSmall).rgb, plain.rgb);
  EXPECT_EQ(scene.Render(time, kSmall).metadata, plain.metadata);
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
  EXPECT_THROW((void)Scene::FromToml("[place]\nlatitude = 91\n", folder_), InputError);
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
