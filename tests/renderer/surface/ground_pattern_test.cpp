// SPDX-License-Identifier: MIT
#include "renderer/surface/ground_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "atmosphere/math/constants.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/renderer/terrain/land_files.h"

namespace alpenglow::renderer {
namespace {

LocalFrame FrameAt(double latitude, double longitude) {
  return {kWgs84, CheckedPlace({latitude, longitude, 0.0})};
}

/// Two places some kilometres apart, in degrees.
struct TwoPlaces {
  double latitude, longitude, other_latitude, other_longitude;
};

// Hard case 27.
TEST(GroundPattern, IsTheSameSeenFromEveryPlace) {
  for (const TwoPlaces& of : {TwoPlaces{46.5, 8.0, 46.52, 8.53},
                              {40.0, 180.0, 40.1, -179.9},
                              {-16.9, 179.95, -17.0, -179.95},
                              {90.0, 0.0, 89.9, 120.0},
                              {-89.95, -70.0, -89.9, 110.0},
                              {0.05, -70.0, -0.05, -70.1},
                              {64.1, -21.0, 63.9, -20.5}}) {
    const LocalFrame frame = FrameAt(of.latitude, of.longitude);
    const LocalFrame other = FrameAt(of.other_latitude, of.other_longitude);
    const GroundPattern pattern(frame), from_other(other);
    const FrameTransform other_from(other, frame);
    for (const glm::dvec3& point : {glm::dvec3(0.0), {3000.0, -7000.0, 1200.0}, {-5e4, 2e4, 0.0}}) {
      const GroundPoint a = pattern.At(point), b = from_other.At(other_from.Point(point));
      EXPECT_NEAR(a.east_m, b.east_m, 1e-6) << of.latitude << " " << of.longitude;
      EXPECT_NEAR(a.north_m, b.north_m, 1e-6);
      EXPECT_NEAR(a.up_m, b.up_m, 1e-6);
    }
    const glm::dvec3 slope = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    const glm::dvec3 same = other_from.Along(slope), up(0.0, 0.0, 1.0);
    EXPECT_NEAR(glm::length(pattern.ToPattern(slope) - from_other.ToPattern(same)), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(pattern.FromPattern(pattern.ToPattern(slope)) - slope), 0.0, 1e-12);
    EXPECT_NEAR(pattern.Northward(slope, up), from_other.Northward(same, other_from.Along(up)),
                1e-7)
        << "at the pole itself, north is rounded away";
  }
}

TEST(GroundPattern, LiesFlatOnTheGroundEverywhere) {
  constexpr int kPlaces = 4000;
  double steepest = 1.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double sine = (2.0 * i + 1.0) / kPlaces - 1.0;
    const double turns = i * std::numbers::phi;
    const GroundPattern pattern(
        FrameAt(std::asin(sine) / kRadiansPerDegree, 360.0 * (turns - std::floor(turns)) - 180.0));
    steepest = std::min(steepest, pattern.ToPattern({0.0, 0.0, 1.0}).z);
  }
  EXPECT_GT(steepest, std::cos(12.0 * kRadiansPerDegree)) << "the bound of the header";
}

TEST(GroundPattern, KnowsWhereNorthIs) {
  for (const double latitude : {46.5, -33.0, 89.0}) {
    const GroundPattern pattern(FrameAt(latitude, 100.0));
    EXPECT_NEAR(pattern.Northward({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}), 1.0, 1e-12);
    EXPECT_NEAR(pattern.Northward({1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}), 0.0, 1e-12);
  }
  const GroundPattern at_pole(FrameAt(90.0, 0.0));
  EXPECT_LT(std::abs(at_pole.Northward({0.6, 0.8, 0.0}, {0.0, 0.0, 1.0})), 1e-6);
}

class PatternsOnAPath : public TemporaryFolder {};

TEST_F(PatternsOnAPath, EqualThoseOfStillsAtTheSamePlaces) {
  // Planes change at 52.5 degrees north.
  const std::filesystem::path model = folder_ / "land.tif";
  tests::WriteModel(model, {7.6, 53.4, 0.01, 0.01, 80, 80}, [](int column, int row) {
    return static_cast<float>(300.0 + 100.0 * std::sin(0.3 * column + 0.2 * row));
  });
  const auto scene_at = [&](double latitude, double height_m) {
    Scene scene = BareScene(height_m, 0.0, -50.0, 20.0);
    scene.medium = MediumPreset("bruneton2017");
    scene.place = CheckedPlace({latitude, 8.0, 0.0});
    scene.terrain = {TerrainSource::Kind::kElevationModel, model, VoidPolicy::kFill};
    return scene;
  };
  const UtcTime noon = ParseInstant("2026-06-21T11:00:00Z");
  RenderSettings settings;
  settings.width = 24;
  settings.height = 16;
  settings.samples_per_pixel = 4;
  CameraSample far(noon);
  const Camera& camera = scene_at(53.0, 2500.0).camera;
  far.poses = {
      {Place{53.0, 8.0, 2500.0}, camera.heading_rad, camera.pitch_rad, 0.0, camera.fov_rad}};
  const HdrImage frame = SceneRenderer(scene_at(52.0, 9000.0), nullptr).Render(far, settings);
  const HdrImage still = SceneRenderer(scene_at(53.0, 2500.0), nullptr).Render(noon, settings);
  double squares = 0.0;
  for (std::size_t i = 0; i < still.rgb.size(); ++i) {
    const double change = std::log(double{frame.rgb[i][1]} / double{still.rgb[i][1]});
    squares += change * change;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(still.rgb.size())), 0.01)
      << "the spheres of the two scenes are 3 m apart";
}

}  // namespace
}  // namespace alpenglow::renderer
