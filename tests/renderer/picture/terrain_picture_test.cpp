// SPDX-License-Identifier: MIT
// Pictures of terrain: covers and slopes, the air over mountains, and the edge of shade on a coarse
// mesh, which is that of the round body that it stands for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <string>

#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/lit_ground/ground_light.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_clouds.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/lamp_site.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/mesh_scene.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

using tests::Luminance;
using RenderAirFiles = TemporaryFolder;

const RenderSettings kSmallGround{
    .width = 12, .height = 8, .samples_per_pixel = 4, .air_nodes = 8, .layers = {}};

// At 46.5 N 8 E on that evening the sun is 15 degrees high, at azimuth 281.
const UtcTime kLowSun = ParseInstant("2026-06-21T17:45:00Z");
const UtcTime kHighSun = ParseInstant("2026-06-21T11:30:00Z");

double MeanLuminance(const SceneRenderer& renderer, const CameraSample& camera_sample,
                     EffectSet effects = EffectSet::All()) {
  RenderSettings settings = kSmallGround;
  settings.effects = effects;
  return tests::MeanLuminance(renderer.Render(camera_sample, settings));
}

/// Returns the luminance of a view over the sea under the low sun; angles are in degrees.
double OverTheSea(double heading, double pitch) {
  static const SceneRenderer renderer([] {
    Scene scene = QuickScene(200.0, 0.0, 0.0, 20.0);
    scene.ground.kind = GroundCover::Kind::kWater;
    return scene;
  }());
  const Camera camera = CameraFromDegrees({}, heading, pitch, 0.0, 20.0);
  CameraSample camera_sample(kLowSun);
  camera_sample.poses = {
      {Place{46.5, 8.0, 200.0}, camera.heading_rad, camera.pitch_rad, 0.0, camera.fov_rad}};
  return MeanLuminance(renderer, camera_sample);
}

TEST(GroundLight, TheSeaGlittersUnderALowSun) {
  EXPECT_GT(OverTheSea(281.0, -15.0), 20.0 * OverTheSea(11.0, -15.0))
      << "the sun's mirror image, spread by waves";
}

TEST(GroundLight, WaterMirrorsTheSkyByFresnelsLaw) {
  // 60 degrees down, water reflects 2 % of the sky and sends light from under its surface.
  const double down = OverTheSea(100.0, -60.0), sky = OverTheSea(100.0, 60.0);
  EXPECT_GT(down, 0.02 * sky);
  EXPECT_LT(down, 0.15 * sky);
}

/// Returns the mean colour (linear sRGB) of a narrow view over nearly calm water below stratus.
glm::dvec3 UnderStratus(double pitch) {
  static const SceneRenderer renderer([] {
    Scene scene = QuickScene(20.0, 0.0, 0.0, 4.0);
    scene.ground.kind = GroundCover::Kind::kWater;
    scene.ground.wind_m_per_s = 0.5;
    scene.clouds = CloudsFromText("overcast");
    return scene;
  }());
  const Camera camera = CameraFromDegrees({}, 100.0, pitch, 0.0, 4.0);
  CameraSample camera_sample(kHighSun);
  camera_sample.poses = {
      {Place{46.5, 8.0, 20.0}, camera.heading_rad, camera.pitch_rad, 0.0, camera.fov_rad}};
  const HdrImage image = renderer.Render(camera_sample, kSmallGround);
  glm::dvec3 sum(0.0);
  for (int row = 0; row < kSmallGround.height; ++row) {
    for (int column = 0; column < kSmallGround.width; ++column)
      sum += glm::dvec3(glm::make_vec3(image.at(column, row).data()));
  }
  return sum / (1.0 * kSmallGround.width * kSmallGround.height);
}

// Waves tilt facets, and water itself sends up hardly any red light, but a twentieth of the blue light
// that falls on it. A clear sky in the mirror would be several times as blue.
TEST(GroundLight, WaterMirrorsTheCloudsAboveIt) {
  const glm::dvec3 sky = UnderStratus(8.0), sea = UnderStratus(-8.0);
  const double reflected = FresnelReflectance(std::sin(8.0 * kRadiansPerDegree), 1.34);
  EXPECT_NEAR(sea.x, reflected * sky.x, 0.2 * reflected * sky.x);
  EXPECT_LT((sea.z / sea.x) / (sky.z / sky.x), 1.4);
}

TEST(GroundLight, CoversAreAsBrightAsTheirAlbedos) {
  Scene scene = QuickScene(200.0, 0.0, -60.0, 20.0);
  scene.ground.kind = GroundCover::Kind::kSnow;
  const double snow = MeanLuminance(SceneRenderer(scene), kHighSun);
  scene.ground.kind = GroundCover::Kind::kLambert;
  scene.ground.albedo = {0.5, 0.5, 0.5};
  const double lambert = MeanLuminance(SceneRenderer(scene), kHighSun);
  EXPECT_NEAR(snow / lambert, 1.95, 0.25) << "0.97 over 0.5, and snow's own distribution";
  scene.ground.kind = GroundCover::Kind::kOrenNayar;
  scene.ground.roughness = 0.0;
  EXPECT_NEAR(MeanLuminance(SceneRenderer(scene), kHighSun) / lambert, 1.0, 1e-5);
}

/// A valley between two walls along the north, as a mesh in a file.
class Valley : public TemporaryFolder {
 protected:
  [[nodiscard]] Scene ValleyScene() const {
    std::string text;
    constexpr int kSide = 41;
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const double x = 50.0 * (column - kSide / 2), y = 50.0 * (row - kSide / 2);
        text += fmt::format("v {} {} {}\n", x, y, 0.8 * std::abs(x));
      }
    }
    for (int row = 0; row + 1 < kSide; ++row) {
      for (int column = 0; column + 1 < kSide; ++column) {
        const int first = 1 + row * kSide + column, above = first + kSide;
        text += fmt::format("f {} {} {} {}\n", first, first + 1, above + 1, above);
      }
    }
    Scene scene =
        tests::MeshScene(QuickScene(400.0, 0.0, -70.0, 60.0), folder_ / "valley.obj", text);
    scene.ground.kind = GroundCover::Kind::kSnow;
    return scene;
  }
};

TEST_F(Valley, IsBrighterByTheLightOfItsWalls) {
  const SceneRenderer renderer(ValleyScene());
  EXPECT_GT(MeanLuminance(renderer, kLowSun),
            1.02 * MeanLuminance(renderer, kLowSun, EffectSet::All().Without(Effect::kBounce)))
      << "snow on one wall lights the other";
}

// Hard case 43.
TEST_F(Valley, HasTheSameBytesForAnyNumberOfThreads) {
  // The picture has a lake, shafts, fog, smoke and a lamp, and a moving camera with a lens.
  Scene scene = ValleyScene();
  scene.ground.sea_level_m = 20.0;
  scene.layers = {MediumLayer{0.004, 40.0, 0.0, 1.0, DropletPhase(12.0)}};
  Volume& smoke = scene.volumes.emplace_back();
  smoke.place = scene.place;
  smoke.height = {100.0, false};
  smoke.size_m = {60.0, 60.0, 60.0};
  smoke.extinction_per_m = {0.02};
  scene.lights = {tests::LampNear(scene.place, 30.0, 10.0, 60.0, 1e6)};
  scene.camera.lens = ThinLens{1.4, 0.085, 300.0, 7, 0.1};
  CameraSample camera_sample(kLowSun);
  for (const double east_deg : {0.0, 1e-5}) {
    const Camera& camera = scene.camera;
    camera_sample.poses.push_back({CheckedPlace({46.5, 8.0 + east_deg, 400.0}), camera.heading_rad,
                                   camera.pitch_rad, 0.0, camera.fov_rad});
  }
  RenderSettings settings = kSmallGround;
  settings.samples_per_pixel = tests::ScaledDown(7, 3);
  settings.layers = {PictureLayer::kDepth, PictureLayer::kLamps};
  const HdrImage image = tests::SameForAnyNumberOfThreads(
      [&] { return SceneRenderer(scene).Render(camera_sample, settings); });
  double lamps = 0.0;
  for (const float value : image.layers[1].values) lamps += static_cast<double>(value);
  EXPECT_GT(lamps, 0.0) << "the lamp is in the picture";
}

double InscatterAt(const HdrImage& image, int x, int y) {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x);
  return Luminance({image.layers[0].values[pixel], image.layers[1].values[pixel],
                    image.layers[2].values[pixel]});
}

const UtcTime kRangeMorning = ParseInstant("2026-06-21T04:20:00Z");

TEST(RenderAir, SharedAirOfAPixelIsRightToATenthOfAPercent) {
  // The camera stands above a hill in the built-in range and looks past the morning sun, with
  // pixels of a tenth of a degree.
  Scene scene = QuickScene(0.0, 0.0, 0.0, 60.0);
  scene.camera = CameraFromDegrees({300.0, true}, 72.0, 0.0, 0.0, 4.2);
  scene.terrain = {};
  const SceneRenderer renderer(scene);
  RenderSettings settings{
      .width = 32, .height = 18, .samples_per_pixel = 16, .air_nodes = 12, .layers = {}};
  settings.layers = {PictureLayer::kInscatter};
  const HdrImage shared = renderer.Render(kRangeMorning, settings);
  settings.share_air = false;
  const HdrImage alone = renderer.Render(kRangeMorning, settings);
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
  const double pixels = 32.0 * 18.0;
  EXPECT_LT(std::sqrt(square / pixels) / (mean / pixels), 1e-3)
      << "one ray along the mean of those that meet the same surface, through the middle where all "
         "do; pixels of a tenth of a degree";
}

// Hard case 40.
TEST_F(RenderAirFiles, ShadedAirInFrontOfAMountainHasNoGlow) {
  // A ridge across the view is 1500 m high and 4 km away; the low sun is behind it.
  const Scene scene =
      tests::MeshScene(QuickScene(50.0, 62.0, 4.0, 10.0), folder_ / "ridge.obj",
                       "v 3000 -60000 0\nv 3000 60000 0\nv 4000 -60000 1500\nv 4000 60000 1500\n"
                       "v 9000 -60000 0\nv 9000 60000 0\nf 1 3 2\nf 2 3 4\nf 3 5 4\nf 4 5 6\n");
  const SceneRenderer renderer(scene);
  RenderSettings settings{
      .width = 16, .height = 9, .samples_per_pixel = 1, .air_nodes = 12, .layers = {}};
  settings.layers = {PictureLayer::kInscatter};
  const HdrImage shaded = renderer.Render(kRangeMorning, settings);
  settings.effects = settings.effects.Without(Effect::kShafts);
  const HdrImage glowing = renderer.Render(kRangeMorning, settings);
  EXPECT_LT(InscatterAt(shaded, 8, 4), 0.35 * InscatterAt(glowing, 8, 4))
      << "what is left was scattered before it came";
  EXPECT_GT(InscatterAt(shaded, 8, 4), 0.0);
  // The sky alone lights it evenly: it is no brighter below the sun than beside it.
  EXPECT_NEAR(InscatterAt(shaded, 8, 4) / InscatterAt(shaded, 0, 4), 1.0, 0.1);
}

TEST(RenderAir, TheSeaHidesTheFootOfDistantMountains) {
  Scene scene = QuickScene(10.0, 180.0, 0.5, 0.1);
  scene.terrain = {};
  scene.terrain.centre = {45.5, 8.0, 0.0};  // 111 km to the south
  const SceneRenderer renderer(scene);
  const RenderSettings settings{
      .width = 5,
      .height = 200,
      .samples_per_pixel = 1,
      .air_nodes = 8,
      .effects = {Effect::kRefraction, Effect::kMolecules, Effect::kAerosol, Effect::kOzone},
      .layers = {PictureLayer::kDepth}};
  const HdrImage image = renderer.Render(ParseInstant("2026-06-21T10:00:00Z"), settings);
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
TEST_F(RenderAirFiles, ARidgeOfNoThicknessHasADarkSide) {
  // A sheet across the view is 1500 m high and 4 km away, with the low sun behind it.
  for (const char* faces : {"f 1 3 2\nf 2 3 4\n", "f 1 2 3\nf 2 4 3\n"}) {
    const Scene scene = tests::MeshScene(
        QuickScene(50.0, 72.0, 4.0, 10.0), folder_ / "sheet.obj",
        "v 4000 -60000 -300\nv 4000 60000 -300\nv 4000 -60000 1500\nv 4000 60000 1500\n" +
            std::string(faces));
    const SceneRenderer renderer(scene);
    RenderSettings settings{
        .width = 16, .height = 9, .samples_per_pixel = 4, .air_nodes = 12, .layers = {}};
    settings.layers = {PictureLayer::kInscatter, PictureLayer::kSunVisibility,
                       PictureLayer::kDepth};
    // The only light comes directly from the sun.
    settings.effects = settings.effects.Without(Effect::kMultipleScattering)
                           .Without(Effect::kSkylight)
                           .Without(Effect::kBounce);
    const HdrImage image = renderer.Render(kRangeMorning, settings);
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

constexpr double kEyeHeight_m = 40.0, kRadius_m = 10.0;
const glm::dvec3 kMiddle(0.0, 40.0, kEyeHeight_m);

class Terminator : public TemporaryFolder {
 protected:
  /// Writes a ball of triangles 12 degrees wide, 40 m north of the eye.
  void SetUp() override {
    TemporaryFolder::SetUp();
    constexpr int kColumns = 30, kRows = 15;
    const auto vertex = [&](int row, int column) {
      if (row == 0 || row == kRows) return row == 0 ? 1 : 2;
      return 3 + (row - 1) * kColumns + column % kColumns;
    };
    std::string text = VertexAt(0.0, 0.0) + VertexAt(kPi, 0.0);
    for (int row = 1; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column)
        text += VertexAt(kPi * row / kRows, 2.0 * kPi * column / kColumns);
    }
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const int a = vertex(row, column), b = vertex(row + 1, column);
        const int c = vertex(row, column + 1), d = vertex(row + 1, column + 1);
        if (a != c) text += fmt::format("f {} {} {}\n", a, b, c);
        if (b != d) text += fmt::format("f {} {} {}\n", c, b, d);
      }
    }
    scene_ = tests::MeshScene(QuickScene(kEyeHeight_m, 0.0, 0.0, 32.0), folder_ / "ball.obj", text);
  }

  static std::string VertexAt(double polar, double turn) {
    const glm::dvec3 up(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                        std::cos(polar));
    const glm::dvec3 at = kMiddle + kRadius_m * up;
    return fmt::format("v {:.9} {:.9} {:.9}\n", at.x, at.y, at.z);
  }

  /// Returns the normal of the ball where a ray from the eye meets it well within its outline.
  static std::optional<glm::dvec3> NormalAt(const glm::dvec3& direction) {
    const glm::dvec3 to_middle = kMiddle - glm::dvec3(0.0, 0.0, kEyeHeight_m);
    const double nearest = glm::dot(to_middle, direction);
    const double across = glm::length(to_middle - nearest * direction);
    if (across > 0.9 * kRadius_m) return std::nullopt;
    const double half = std::sqrt(kRadius_m * kRadius_m - across * across);
    return glm::normalize((nearest - half) * direction - to_middle);
  }

  Scene scene_;
};

// Below this cosine triangle and ball differ: the triangle's plane is 0.006 radii below, which
// shifts a ray that meets it at 25 degrees by 0.013 radii.
constexpr double kEdge = 0.03;

TEST_F(Terminator, SunlightEndsWhereTheRoundBodyTurnsAway) {
  const SceneRenderer renderer(scene_);
  const CameraSample evening(ParseInstant("2026-06-21T17:30:00Z"));
  const RenderSettings settings{.width = 96,
                                .height = 54,
                                .samples_per_pixel = 1,
                                .air_nodes = 4,
                                .layers = {PictureLayer::kSunVisibility}};
  const HdrImage picture = renderer.Render(evening, settings);
  const SunInSky sun = renderer.ApparentSun(evening);
  const glm::dvec3 to_sun = EnuFromAngles(sun.elevation_rad(), sun.azimuth_rad()).xyz;
  const CameraRays camera(scene_.camera, settings.width, settings.height);
  int lit = 0, dark = 0, near_the_edge = 0;
  for (int y = 0; y < settings.height; ++y) {
    for (int x = 0; x < settings.width; ++x) {
      const auto normal = NormalAt(camera.Direction(x + 0.5, y + 0.5));
      if (!normal) continue;
      const double cosine = glm::dot(*normal, to_sun);
      const float seen = picture.layers[0].values[static_cast<std::size_t>(y * 96 + x)];
      if (std::abs(cosine) > kEdge) {
        EXPECT_EQ(seen, cosine > 0.0 ? 1.0F : 0.0F) << x << ", " << y << ": cosine " << cosine;
      }
      ++(cosine > 0.0 ? lit : dark);
      if (std::abs(cosine) > kEdge && std::abs(cosine) < 0.1) ++near_the_edge;
    }
  }
  EXPECT_GT(lit, 100);
  EXPECT_GT(dark, 100);
  EXPECT_GT(near_the_edge, 30) << "within a triangle's width of the edge";
}

TEST_F(Terminator, LampLightEndsWhereTheRoundBodyTurnsAway) {
  // The lamp is 100 m to the east; the edge of shade lies across rows of triangles.
  scene_.lights = {tests::LampNear(scene_.place, 0.0, 100.0, kEyeHeight_m + 60.0, 1000.0)};
  const tests::LampSite site(scene_);
  const glm::dvec3 from = site.light.At(0).lamp.position_m;
  const CameraRays camera(scene_.camera, 96, 54);
  int near_the_edge = 0;
  for (int y = 0; y < 54; ++y) {
    for (int x = 0; x < 96; ++x) {
      const glm::dvec3 direction = camera.Direction(x + 0.5, y + 0.5);
      if (!NormalAt(direction)) continue;
      const auto hit = site.ground.terrain->Intersect({0.0, 0.0, kEyeHeight_m}, direction);
      ASSERT_TRUE(hit);
      const glm::dvec3 point = glm::dvec3(0.0, 0.0, kEyeHeight_m) + hit->distance_m * direction;
      const glm::dvec3 way = from - point;
      const double cosine = glm::dot(hit->normal, glm::normalize(way));
      if (!(cosine > kEdge && cosine < 0.1)) continue;
      ++near_the_edge;
      const Spectrum seen =
          site.light.OnSurface({0}, {point, hit->smooth_point, hit->normal, hit->geometric_normal});
      const double facing = static_cast<double>(site.light.At(0).intensity[0]) / glm::dot(way, way);
      EXPECT_NEAR(static_cast<double>(seen[0]) / facing, cosine, 0.003)
          << x << ", " << y << ": 100 m of air take a part of the cosine and glow as much";
    }
  }
  EXPECT_GT(near_the_edge, 30);
}

}  // namespace
}  // namespace alpenglow::renderer
