// SPDX-License-Identifier: MIT
// Pictures of the air over terrain.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "atmosphere/refraction/refracted_view.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

using tests::Luminance;

double InscatterAt(const Image& image, int x, int y) {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x);
  return Luminance({image.layers[0].values[pixel], image.layers[1].values[pixel],
                    image.layers[2].values[pixel]});
}

// The built-in range from above a hill in it, past the morning sun; pixels of a tenth of a degree.
const SceneRenderer& RangeRenderer() {
  static const SceneRenderer kRenderer([] {
    Scene scene = BareScene(0.0, 0.0, 0.0, 60.0);
    scene.camera = CameraFromDegrees({300.0, true}, 72.0, 0.0, 0.0, 6.4);
    scene.terrain = {};
    return scene;
  }());
  return kRenderer;
}

class RenderAirFiles : public TemporaryFolder {};

const UtcInstant kMorning = ParseInstant("2026-06-21T04:20:00Z");

// Hard case 43.
TEST(RenderAir, ShaftsAreTheSameBytesForAnyNumberOfThreads) {
  const SceneRenderer& renderer = RangeRenderer();
  const RenderSettings settings{
      .width = 32, .height = 18, .samples_per_pixel = 4, .air_nodes = 12, .layers = {}};
  static_cast<void>(
      tests::SameForAnyNumberOfThreads([&] { return renderer.Render(kMorning, settings); }));
}

TEST(RenderAir, SharingTheAirOfAPixelIsRightToATenthOfAPercentOfTheLight) {
  const SceneRenderer& renderer = RangeRenderer();
  RenderSettings settings{
      .width = 64, .height = 36, .samples_per_pixel = 16, .air_nodes = 12, .layers = {}};
  settings.layers = {PictureLayer::kInscatter};
  const Image shared = renderer.Render(kMorning, settings);
  settings.share_air = false;
  const Image alone = renderer.Render(kMorning, settings);
  double square = 0.0;
  double mean = 0.0;
  for (int y = 0; y < shared.height; ++y) {
    for (int x = 0; x < shared.width; ++x) {
      const double truth = InscatterAt(alone, x, y);
      const double error = InscatterAt(shared, x, y) - truth;
      square += error * error;
      mean += truth;
    }
  }
  const double pixels = 64.0 * 36.0;
  EXPECT_LT(std::sqrt(square / pixels) / (mean / pixels), 1e-3)
      << "one ray along the mean of those that meet the same surface, through the middle where all "
         "do; pixels of a tenth of a degree";
}

// Hard case 40.
TEST_F(RenderAirFiles, AMountainBeforeTheSunHasNoGlowInItsShadedAir) {
  // A ridge across the view, 1500 m high and 4 km off; the sun stands behind it, low.
  const std::filesystem::path file = folder_ / "ridge.obj";
  WriteText(file,
            "v 3000 -60000 0\nv 3000 60000 0\nv 4000 -60000 1500\nv 4000 60000 1500\n"
            "v 9000 -60000 0\nv 9000 60000 0\nf 1 3 2\nf 2 3 4\nf 3 5 4\nf 4 5 6\n");
  Scene scene = BareScene(0.0, 62.0, 4.0, 10.0);
  scene.camera = CameraFromDegrees({50.0, false}, 62.0, 4.0, 0.0, 10.0);
  scene.terrain = {TerrainSource::Kind::kMesh, file, VoidPolicy::kFill};
  const SceneRenderer renderer(scene);
  RenderSettings settings{
      .width = 16, .height = 9, .samples_per_pixel = 1, .air_nodes = 12, .layers = {}};
  settings.layers = {PictureLayer::kInscatter};
  const Image shaded = renderer.Render(kMorning, settings);
  settings.effects = settings.effects.Without(Effect::kShafts);
  const Image glowing = renderer.Render(kMorning, settings);
  EXPECT_LT(InscatterAt(shaded, 8, 4), 0.35 * InscatterAt(glowing, 8, 4))
      << "what is left was scattered before it came";
  EXPECT_GT(InscatterAt(shaded, 8, 4), 0.0);
  // Evenly lit by the sky alone: no brighter below the sun than beside it.
  EXPECT_NEAR(InscatterAt(shaded, 8, 4) / InscatterAt(shaded, 0, 4), 1.0, 0.1);
}

TEST(RenderAir, TheSeaHidesTheFootOfMountainsBehindItsHorizon) {
  Scene scene = BareScene(10.0, 180.0, 0.5, 0.1);
  scene.terrain = {};
  scene.terrain.centre = PlaceFromDegrees(45.5, 8.0, 0.0);  // 111 km to the south
  const SceneRenderer renderer(scene);
  RenderSettings settings{
      .width = 5, .height = 200, .samples_per_pixel = 1, .air_nodes = 8, .layers = {}};
  settings.layers = {PictureLayer::kDepth};
  const Image image = renderer.Render(ParseInstant("2026-06-21T10:00:00Z"), settings);
  const CameraRays camera(scene.camera, 5, 200);
  const double dip = -RefractedView(renderer.medium(), 10.0).horizon_rad();
  int mountains = 0;
  for (int y = 0; y < 200; ++y) {
    const double depth_m =
        static_cast<double>(image.layers[0].values[static_cast<std::size_t>(y) * 5 + 2]);
    if (camera.Direction(2.5, y + 0.5).z < -1.02 * dip) {
      EXPECT_LT(depth_m, 12.4e3) << "row " << y << ": the sea, before its horizon at 12.2 km";
    } else if (std::isfinite(depth_m)) {
      ++mountains;
      EXPECT_GT(depth_m, 70e3) << "row " << y;
    }
  }
  EXPECT_GT(mountains, 20) << "the peaks stand out of the sea";
}

// Hard case 41.
TEST_F(RenderAirFiles, ARidgeOfNoThicknessHasADarkSideAndDarkAirBeforeIt) {
  // A sheet across the view, 1500 m high and 4 km off, the sun low behind it, both windings.
  const std::filesystem::path file = folder_ / "sheet.obj";
  for (const char* faces : {"f 1 3 2\nf 2 3 4\n", "f 1 2 3\nf 2 4 3\n"}) {
    WriteText(file,
              "v 4000 -60000 -300\nv 4000 60000 -300\nv 4000 -60000 1500\nv 4000 60000 1500\n" +
                  std::string(faces));
    Scene scene = BareScene(50.0, 72.0, 4.0, 10.0);
    scene.terrain = {TerrainSource::Kind::kMesh, file, VoidPolicy::kFill};
    const SceneRenderer renderer(scene);
    RenderSettings settings{
        .width = 16, .height = 9, .samples_per_pixel = 4, .air_nodes = 12, .layers = {}};
    settings.layers = {PictureLayer::kInscatter, PictureLayer::kSunVisibility,
                       PictureLayer::kDepth};
    // What light there is comes straight from the sun.
    settings.effects = settings.effects.Without(Effect::kMultipleScattering)
                           .Without(Effect::kSkylight)
                           .Without(Effect::kBounce);
    const Image image = renderer.Render(kMorning, settings);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y * image.width + x);
        EXPECT_EQ(InscatterAt(image, x, y), 0.0) << faces << x << ", " << y;
        EXPECT_EQ(image.layers[3].values[pixel], 0.0F) << faces << x << ", " << y;
        EXPECT_NEAR(image.layers[4].values[pixel], 4200.0F, 500.0F) << "the sheet, or its foot";
        EXPECT_EQ(Luminance(image.rgb[pixel]), 0.0) << faces << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
