// SPDX-License-Identifier: MIT
#include "renderer/picture/ground_light.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "atmosphere/math/constants.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

const RenderSettings kSmall{
    .width = 24, .height = 16, .samples_per_pixel = 4, .air_nodes = 8, .layers = {}};

using tests::Luminance;

/// Looking down on the bare planet towards a heading, of one cover.
Scene Planet(GroundCover::Kind kind, double heading, double pitch) {
  Scene scene = BareScene(200.0, heading, pitch, 20.0);
  scene.ground.kind = kind;
  return scene;
}

double MeanLuminance(const Scene& scene, const char* time) {
  const Image image = SceneRenderer(scene).Render(ParseInstant(time), kSmall);
  double sum = 0.0;
  for (const auto& rgb : image.rgb) sum += Luminance(rgb) / static_cast<double>(image.rgb.size());
  return sum;
}

// At 46.5 N 8 E on that evening the sun stands 15 degrees high, at azimuth 281.
constexpr const char* kEvening = "2026-06-21T17:45:00Z";

TEST(GroundLight, SeaGlittersUnderALowSunAndNowhereElse) {
  const double under_sun = MeanLuminance(Planet(GroundCover::Kind::kWater, 281.0, -15.0), kEvening);
  const double aside = MeanLuminance(Planet(GroundCover::Kind::kWater, 11.0, -15.0), kEvening);
  EXPECT_GT(under_sun, 20.0 * aside) << "the sun's mirror image, spread by waves";
}

TEST(GroundLight, WaterAwayFromTheSunShowsTheSkyByFresnelsLaw) {
  // Looking 60 degrees down: 2 % of the sky over it, and light from under the surface.
  const double down = MeanLuminance(Planet(GroundCover::Kind::kWater, 100.0, -60.0), kEvening);
  const double sky = MeanLuminance(BareScene(200.0, 100.0, 60.0, 20.0), kEvening);
  EXPECT_GT(down, 0.02 * sky);
  EXPECT_LT(down, 0.15 * sky);
}

TEST(GroundLight, CoversAreAsBrightAsTheirAlbedos) {
  Scene grey = Planet(GroundCover::Kind::kLambert, 0.0, -60.0);
  grey.ground.albedo = {0.5, 0.5, 0.5};
  const double lambert = MeanLuminance(grey, "2026-06-21T11:30:00Z");
  const double snow =
      MeanLuminance(Planet(GroundCover::Kind::kSnow, 0.0, -60.0), "2026-06-21T11:30:00Z");
  EXPECT_NEAR(snow / lambert, 1.95, 0.25) << "0.97 over 0.5, and snow's own distribution";
  grey.ground.kind = GroundCover::Kind::kOrenNayar;
  grey.ground.roughness = 0.0;
  EXPECT_NEAR(MeanLuminance(grey, "2026-06-21T11:30:00Z") / lambert, 1.0, 1e-5);
}

/// A valley between two walls along the north, as a mesh of a file.
class Valley : public TemporaryFolder {
 protected:
  [[nodiscard]] Scene ValleyScene() const {
    const std::filesystem::path file = folder_ / "valley.obj";
    std::ofstream text(file);
    constexpr int kSide = 41;
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const double x = 50.0 * (column - kSide / 2), y = 50.0 * (row - kSide / 2);
        text << "v " << x << " " << y << " " << 0.8 * std::abs(x) << "\n";
      }
    }
    const auto vertex = [](int column, int row) { return 1 + row * kSide + column; };
    for (int row = 0; row + 1 < kSide; ++row) {
      for (int column = 0; column + 1 < kSide; ++column) {
        text << "f " << vertex(column, row) << " " << vertex(column + 1, row) << " "
             << vertex(column + 1, row + 1) << " " << vertex(column, row + 1) << "\n";
      }
    }
    Scene scene = BareScene(400.0, 0.0, -70.0, 60.0);
    scene.terrain.kind = TerrainSource::Kind::kMesh;
    scene.terrain.file = file;
    scene.ground.kind = GroundCover::Kind::kSnow;
    return scene;
  }

  [[nodiscard]] static double MeanWith(const SceneRenderer& renderer, EffectSet effects) {
    RenderSettings settings = kSmall;
    settings.effects = effects;
    const Image image = renderer.Render(ParseInstant(kEvening), settings);
    double sum = 0.0;
    for (const auto& rgb : image.rgb) sum += Luminance(rgb);
    return sum;
  }
};

TEST_F(Valley, IsBrighterByTheLightOfItsWalls) {
  const SceneRenderer renderer(ValleyScene());
  const EffectSet all = EffectSet::All();
  const double with_walls = MeanWith(renderer, all);
  const double without_bounce = MeanWith(renderer, all.Without(Effect::kBounce));
  EXPECT_GT(with_walls, 1.02 * without_bounce) << "snow on one wall lights the other";
}

// Hard case 43.
TEST_F(Valley, IsTheSameBytesForAnyNumberOfThreads) {
  Scene scene = ValleyScene();
  scene.ground.sea_level_m = 20.0;  // a lake in it
  std::vector<Image> images;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    images.push_back(SceneRenderer(scene).Render(ParseInstant(kEvening), kSmall));
  }
  EXPECT_EQ(images[0].rgb, images[1].rgb);
  EXPECT_EQ(images[0].rgb, images[2].rgb);
}

}  // namespace
}  // namespace alpenglow::renderer
