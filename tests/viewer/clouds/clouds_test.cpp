// SPDX-License-Identifier: MIT
// Clouds in the viewer: values of textures against the tables that they are made from, and pictures
// against the renderer's.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/reference_picture.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_options.h"
#include "renderer/terrain/land_source.h"
#include "tests/fixtures/sanitized.h"
#include "tests/viewer/air/shared_air.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/clouds/cloud_follower.h"
#include "viewer/clouds/cloud_texels.h"
#include "viewer/passes/sky_painter.h"

namespace alpenglow::viewer {
namespace {

constexpr const char* kMorning = "2026-06-21T08:00:00Z";
// The sun is 6 degrees high.
constexpr const char* kEvening = "2026-06-21T18:45:00Z";

// Returns a scene over the bare planet with a small field of clouds.
Scene CloudyScene(const std::string& clouds, const char* time) {
  Scene scene;
  scene.place = {46.5, 8.0, 0.0};
  scene.medium = MediumPreset("earth");
  scene.time = ParseInstant(time);
  scene.terrain.kind = TerrainSource::Kind::kNone;
  scene.clouds = CloudsFromText(clouds);
  for (SceneCloud& layer : scene.clouds) layer.options.period_m = 5120.0;
  return scene;
}

SolvedClouds SolvedCumulus(const glm::dvec3& to_light = glm::normalize(glm::dvec3(0.5, 0.3, 0.8))) {
  const Scene scene = CloudyScene("cumulus 0.3", kMorning);
  CloudsByTime clouds(scene, 0.0, 6371e3);
  return *clouds.At(*scene.time, {to_light});
}

double Value(HalfBits bits) { return static_cast<double>(glm::unpackHalf1x16(bits)); }

// Returns the extinction [1/m] at the corner of a voxel, as clouds/march.glsl finds it.
double ExtinctionOfTexels(const CloudLayerTexels& layer, const std::array<int, 3>& voxel) {
  const auto number = static_cast<std::size_t>(
      (voxel[2] / 8 * layer.bricks[1] + voxel[1] / 8) * layer.bricks[0] + voxel[0] / 8);
  const std::int32_t brick = layer.brick[number];
  if (brick < 0) return 0.0;
  const int x = 9 * (brick & 1023) + voxel[0] % 8, y = 9 * (brick >> 10 & 1023) + voxel[1] % 8,
            z = 9 * (brick >> 20 & 1023) + voxel[2] % 8;
  const std::size_t texel = static_cast<std::size_t>((z * 9 * layer.tiles[1] + y)) *
                                static_cast<std::size_t>(9 * layer.tiles[0]) +
                            static_cast<std::size_t>(x);
  const int code = layer.depth[texel];
  const double altitude_m = layer.origin_m.z + voxel[2] * layer.voxel_m;
  const double row = (CloudLayerTexels::kExtinctionRows - 1) * (altitude_m - layer.range.low_m) /
                     (layer.range.high_m - layer.range.low_m);
  const auto below =
      static_cast<std::size_t>(std::clamp(row, 0.0, CloudLayerTexels::kExtinctionRows - 2.0));
  const auto at = [&](std::size_t of_row) {
    return 1e-3 * Value(layer.extinction[of_row * CloudLayerTexels::kBytes +
                                         static_cast<std::size_t>(code)]);
  };
  return std::lerp(at(below), at(below + 1), row - static_cast<double>(below));
}

// The table of altitudes has 128 rows, and halves have 11 bits.
TEST(CloudTexels, ExtinctionAtCornersIsThatOfTheField) {
  const SolvedClouds clouds = SolvedCumulus();
  const CloudTexels texels = TexelsOfClouds(clouds);
  const CloudLayerTexels& layer = texels.layer.front();
  const CloudField& field = clouds.layers->front().field;
  int in_cloud = 0;
  double difference = 0.0, sum = 0.0;
  for (int z = 0; z < 8 * layer.bricks[2]; ++z) {
    for (int y = 3; y < 8 * layer.bricks[1]; y += 7) {
      for (int x = 2; x < 8 * layer.bricks[0]; x += 5) {
        const double expected =
            field.Extinction_per_m(layer.origin_m + layer.voxel_m * (glm::dvec3(x, y, z) + 1e-6));
        const double found = ExtinctionOfTexels(layer, {x, y, z});
        in_cloud += expected > 1e-3 ? 1 : 0;
        difference += std::abs(found - expected);
        sum += expected;
      }
    }
  }
  EXPECT_GT(in_cloud, 100);
  EXPECT_LT(difference, 0.01 * sum);
}

// Returns the root mean square error of sources by four patterns, relative to that of the sources.
double ErrorOfPatterns(const CloudMoments& moments, const CloudOptics& optics,
                       const std::vector<HalfBits>& components, const glm::vec4* basis,
                       const CloudLayerTexels& layer) {
  const CloudCellLattice lattice = moments.cells().lattice();
  double squares = 0.0, all = 0.0;
  for (int row = 3; row < CloudLayerTexels::kElevations; row += 13) {
    for (int column = 5; column < CloudLayerTexels::kAzimuths; column += 31) {
      const double elevation = kPi * ((row + 0.5) / CloudLayerTexels::kElevations - 0.5);
      const double azimuth = 2.0 * kPi * (column + 0.5) / CloudLayerTexels::kAzimuths;
      const glm::dvec3 view(std::cos(elevation) * std::sin(azimuth),
                            std::cos(elevation) * std::cos(azimuth), std::sin(elevation));
      const CloudHarmonics factors = optics.SourceFactors(-view);
      const glm::vec4 functions = basis[row * CloudLayerTexels::kAzimuths + column];
      for (std::size_t cell = 0; cell < moments.cells().full(); cell += 7) {
        double expected = 0.0, found = 0.0;
        for (std::size_t k = 0; k < kCloudMoments; ++k)
          expected += static_cast<double>(factors[k]) * static_cast<double>(moments.Of(cell)[k]);
        const glm::ivec3 at((moments.cells().Middle(cell) - lattice.origin_m) / lattice.cell_m);
        const auto texel =
            static_cast<std::size_t>((at.z * layer.cells[1] + at.y) * layer.cells[0] + at.x);
        for (std::size_t p = 0; p < 4; ++p)
          found += Value(components[4 * texel + p]) *
                   static_cast<double>(functions[static_cast<int>(p)]);
        squares += (found - expected) * (found - expected);
        all += expected * expected;
      }
    }
  }
  return std::sqrt(squares / all);
}

// Measured: 0.067 in the light of the sun.
TEST(CloudTexels, FourPatternsHoldTheLightOfHigherOrders) {
  constexpr double kMostOfPatterns = 0.08;
  const SolvedClouds clouds = SolvedCumulus();
  const CloudTexels texels = TexelsOfClouds(clouds);
  const CloudLayerTexels& layer = texels.layer.front();
  const CloudLight& light = clouds.light.front();
  const std::size_t half = layer.basis.size() / 2;
  EXPECT_LT(ErrorOfPatterns(light.sun_moments().moments, light.optics(), layer.sun,
                            layer.basis.data(), layer),
            kMostOfPatterns);
  EXPECT_LT(ErrorOfPatterns(light.sky_moments().moments, light.optics(), layer.sky,
                            layer.basis.data() + half, layer),
            kMostOfPatterns);
}

TEST(CloudTexels, NodesOfLightHaveTheTransmittanceOfTheMap) {
  const SolvedClouds clouds = SolvedCumulus();
  const CloudTexels texels = TexelsOfClouds(clouds);
  const CloudSunTexels& sun = texels.sun;
  const CloudSunTexels::Layer& layer = sun.layer.front();
  const CloudLayerTexels& place = texels.layer.front();
  for (int level = 0; level < layer.levels; level += 5) {
    for (int node = 7; node < sun.nodes; node += 101) {
      const double z = layer.low_m + level * layer.level_m;
      const glm::dvec2 foot = glm::dvec2(place.origin_m) +
                              glm::dvec2(node + 0.5, 11.5) / double(sun.nodes) * place.size_m;
      const glm::dvec3 point(foot + (z - layer.low_m) * layer.slope, z);
      const auto texel = static_cast<std::size_t>(((layer.first + level) * sun.nodes + 11)) *
                             static_cast<std::size_t>(sun.nodes) +
                         static_cast<std::size_t>(node);
      EXPECT_NEAR(Value(sun.transmittance[texel]), clouds.light.front().SunTransmittance(point),
                  1e-3);
    }
  }
}

TEST(CloudTexels, ALightThatNoCloudSeesCastsNoShadow) {
  const SolvedClouds clouds = SolvedCumulus({0.0, 0.0, -1.0});
  ASSERT_TRUE(clouds.light.front().sun().IsUnlit());
  const CloudTexels texels = TexelsOfClouds(clouds);
  const auto is = [](double expected) {
    return [expected](HalfBits bits) { return Value(bits) == expected; };
  };
  EXPECT_EQ(texels.sun.levels, 1);
  EXPECT_TRUE(std::ranges::all_of(texels.sun.transmittance, is(1.0)));
  EXPECT_TRUE(std::ranges::all_of(texels.layer.front().sun, is(0.0)));
  EXPECT_FALSE(std::ranges::all_of(texels.layer.front().sky, is(0.0)));
}

constexpr struct CloudPictureSize {
  int width, height;
} kCloudPicture{160, 90}, kSmallCloudPicture = tests::ScaledDown(kCloudPicture, {48, 27});
constexpr int kCloudSamples = 4;

/// Returns the differences of pixels between a view by the renderer's fast method and by the painter at
/// high quality.
ErrorStatistics ViewDifference(const Scene& scene, double height_m, double heading_deg,
                               double pitch_deg, CloudyPixels pixels = CloudyPixels::kCloudy) {
  CameraPose eye{scene.place, heading_deg * kRadiansPerDegree, pitch_deg * kRadiansPerDegree, 0.0,
                 70.0 * kRadiansPerDegree};
  eye.place.height_m = height_m;
  const PaintedView view{eye, *scene.time, kSmallCloudPicture.width, kSmallCloudPicture.height};
  RenderSettings settings = ComparisonSettings(view.width, view.height, kCloudSamples);
  settings.layers.push_back(PictureLayer::kClouds);
  CameraSample camera(view.now);
  camera.poses = {eye};
  const HdrImage reference = SceneRenderer(scene).Render(camera, settings);
  SkyPainter painter(scene, LandSourceOf(scene), view, SizesOf(Quality::kHigh),
                     tests::SharedAirOf(scene));
  painter.WaitUntilReady(view, kCloudSamples);
  painter.Paint(view, kCloudSamples);
  return DifferenceOf(reference, painter.picture().Read(), pixels).value();
}

/// Follows clouds over ground without terrain, lit from 50 degrees above the horizon.
class FollowedClouds {
 public:
  explicit FollowedClouds(const Scene& scene, double ground_m = 0.0)
      : scene_(scene),
        clouds_(scene, {LocalFrame(EllipsoidOf(scene.medium), {46.5, 8.0, 0.0}), std::nullopt, 0.0,
                        "", true}),
        ground_m_(ground_m) {}

  [[nodiscard]] const CloudFollower& operator*() const { return clouds_; }
  [[nodiscard]] const CloudFollower* operator->() const { return &clouds_; }
  void Use(const std::string& clouds) {
    clouds_.Use(CloudyScene(clouds, kMorning).clouds, ground_m_);
  }
  void Follow(double seconds) { clouds_.Follow(air_, scene_.place, *scene_.time, light_, seconds); }
  void WaitUntilReady() { clouds_.WaitUntilReady(air_, scene_.place, *scene_.time, light_); }
  [[nodiscard]] const CloudOptions& shown() const {
    return clouds_.shown().made.of.scene->clouds.front().options;
  }

 private:
  Scene scene_;
  CloudFollower clouds_;
  double ground_m_;
  std::shared_ptr<const SolvedAir> air_ = std::shared_ptr<const SolvedAir>(
      tests::SharedAirOf(scene_), &tests::SharedAirOf(scene_)->air);
  glm::dvec3 to_light_{0.6, 0.2, std::sqrt(0.6)};
  DistantLight light_{LightSource::kSun, {to_light_, to_light_}, 0.0047, Spectrum(1.0)};
};

class CloudsOfAScene : public tests::Headless {};

TEST_F(CloudsOfAScene, AreNotMadeForValuesThatASliderPasses) {
  FollowedClouds clouds(CloudyScene("cumulus 0.2", kMorning));
  clouds.WaitUntilReady();
  const CloudOptions first = clouds.shown();
  constexpr double kFrame_s = 0.05;
  for (const char* passed : {"cumulus 0.25", "cumulus 0.3", "cumulus 0.35"}) {
    clouds.Use(passed);
    clouds.Follow(kFrame_s);
  }
  while (clouds.shown() == first) {
    clouds.Follow(kFrame_s);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(clouds.shown().cover, 0.35);
}

// Returns the lowest altitude of clouds [m] that a scene without any gets later, over ground of a height.
double LowestCloudOver(double ground_m) {
  FollowedClouds clouds(CloudyScene("none", kMorning), ground_m);
  EXPECT_FALSE(clouds->IsShown());
  clouds.Use("cumulus 0.2");
  clouds.WaitUntilReady();
  return clouds->shown().made.texels->layer.front().range.low_m;
}

TEST_F(CloudsOfAScene, ThatBeganWithoutAnyLieOverItsGround) {
  constexpr double kGround_m = 700.0;
  EXPECT_NEAR(LowestCloudOver(kGround_m) - LowestCloudOver(0.0), kGround_m, 1e-6);
}

class CloudsInPictures : public tests::Headless {};

// Pictures of 48 by 27 pixels have more edges of clouds a pixel than larger ones: 0.121 and 0.53 from the
// ground, and 0.26 and 1.33 towards a low sun.
constexpr double kMostMean = tests::ScaledDown(0.08, 0.14);
constexpr double kMostOf99 = tests::ScaledDown(0.35, 0.6);

TEST_F(CloudsInPictures, FromTheGroundAreThoseOfTheRenderer) {
  const ErrorStatistics difference =
      ViewDifference(CloudyScene("cumulus 0.3", kMorning), 2.0, 60.0, 20.0);
  EXPECT_LT(difference.mean(), kMostMean);
  EXPECT_LT(difference.Quantile(0.99), kMostOf99);
}

TEST_F(CloudsInPictures, FromAboveAreThoseOfTheRenderer) {
  const ErrorStatistics difference =
      ViewDifference(CloudyScene("cumulus 0.3", kMorning), 4000.0, 200.0, -20.0);
  EXPECT_LT(difference.mean(), kMostMean);
  EXPECT_LT(difference.Quantile(0.99), kMostOf99);
}

// Clouds below brighten it by a tenth.
TEST_F(CloudsInPictures, TheSkyOverThemIsThatOfTheRenderer) {
  const Scene scene = CloudyScene("cumulus 0.3", kMorning);
  EXPECT_LT(ViewDifference(scene, 3000.0, 200.0, 10.0, CloudyPixels::kClear).mean(), 0.03);
}

// Measured: 0.123 and 0.855. Rims of clouds are many times as bright as their shade towards the sun.
TEST_F(CloudsInPictures, TowardsALowSunAreNearThoseOfTheRenderer) {
  const ErrorStatistics difference =
      ViewDifference(CloudyScene("cumulus 0.3", kEvening), 2.0, 295.0, 10.0);
  EXPECT_LT(difference.mean(), tests::ScaledDown(0.15, 0.3));
  EXPECT_LT(difference.Quantile(0.99), tests::ScaledDown(0.95, 1.5));
}

TEST_F(CloudsInPictures, AnOvercastSkyIsThatOfTheRenderer) {
  const ErrorStatistics difference =
      ViewDifference(CloudyScene("stratus", kMorning), 2.0, 60.0, 15.0);
  EXPECT_LT(difference.mean(), 0.03);
  EXPECT_LT(difference.Quantile(0.99), 0.08);
}

/// Draws a moving picture with clouds.
class MovingClouds : public tests::Headless {
 protected:
  MovingClouds() : scene_(CloudyScene("cumulus 0.3", kMorning)) {}

  /// Returns the view after a way to the north and a turn.
  [[nodiscard]] PaintedView ViewAfter(double north_m, double turned_deg) const {
    CameraPose eye{scene_.place, turned_deg * kRadiansPerDegree, 20.0 * kRadiansPerDegree, 0.0,
                   70.0 * kRadiansPerDegree};
    eye.place = LocalFrame(kWgs84, scene_.place).GeodeticFromEnu(Point<Enu>{{0.0, north_m, 0.0}});
    eye.place.height_m = 1000.0;
    // The last row of rays through clouds lies at the border of a picture of odd height.
    constexpr int kOddHeight = 2 * (kSmallCloudPicture.height / 2) + 1;
    return {eye, *scene_.time, kSmallCloudPicture.width, kOddHeight};
  }
  /// Draws a picture of its own.
  HdrImage Alone(const PaintedView& view) {
    painter().WaitUntilReady(view);
    painter().Paint(view);
    return painter().picture().Read();
  }
  /// Draws a frame that continues those before.
  HdrImage Next(const PaintedView& view) {
    constexpr double kFrame_s = 0.05;
    painter().Update(view, kFrame_s);
    painter().Paint(view);
    return painter().picture().Read();
  }
  static ErrorStatistics Changes(const HdrImage& from, const HdrImage& to) {
    std::vector<double> changes;
    for (std::size_t i = 0; i < from.rgb.size(); ++i)
      changes.push_back(PixelChange(from.rgb[i], to.rgb[i], ChangeFloor(from)));
    return ErrorStatistics(std::move(changes));
  }

 private:
  SkyPainter& painter() {
    if (!painter_) {
      painter_.emplace(scene_, LandSourceOf(scene_), ViewAfter(0.0, 0.0), SizesOf(Quality::kMedium),
                       tests::SharedAirOf(scene_));
    }
    return *painter_;
  }

  Scene scene_;
  std::optional<SkyPainter> painter_;
};

constexpr int kRounds = 4;  // frames in which all rays of a map are followed

// Rays of the map around a place have a weight of 1e-4 each.
TEST_F(MovingClouds, AStillViewHasTheLightOfAllRays) {
  const HdrImage alone = Alone(ViewAfter(0.0, 0.0));
  HdrImage next;
  for (int i = 0; i <= kRounds; ++i) next = Next(ViewAfter(0.0, 0.0));
  EXPECT_LT(Changes(alone, next).Largest(), 0.01);
}

TEST_F(MovingClouds, AnotherViewHasNoLightOfTheOneBefore) {
  static_cast<void>(Alone(ViewAfter(0.0, 0.0)));
  static_cast<void>(Next(ViewAfter(0.0, 0.0)));
  for (const PaintedView& jump : {ViewAfter(0.0, 5.0), ViewAfter(500.0, 5.0)}) {
    const HdrImage next = Next(jump);
    EXPECT_LT(Changes(Alone(jump), next).Largest(), 0.01);
  }
}

// Light that is three frames old has been interpolated in the map three times.
TEST_F(MovingClouds, AFlightHasNearlyTheLightOfAllRays) {
  constexpr double kStep_m = 10.0, kTurn_deg = 0.3;
  static_cast<void>(Alone(ViewAfter(0.0, 0.0)));
  HdrImage next;
  constexpr int kFrames = 2 * kRounds;
  for (int i = 1; i <= kFrames; ++i) next = Next(ViewAfter(kStep_m * i, kTurn_deg * i));
  const ErrorStatistics changes =
      Changes(Alone(ViewAfter(kStep_m * kFrames, kTurn_deg * kFrames)), next);
  EXPECT_LT(changes.mean(), 0.05);
  EXPECT_GT(changes.Largest(), 0.0) << "most rays are not followed in a frame";
}

}  // namespace
}  // namespace alpenglow::viewer
