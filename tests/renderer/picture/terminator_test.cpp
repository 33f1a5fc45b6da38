// SPDX-License-Identifier: MIT
// The edge of shade on a coarse mesh with smooth normals: that of the round body it stands for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "atmosphere/math/constants.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/picture/render.h"
#include "renderer/surface/scene_ground.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEyeHeight_m = 40.0, kRadius_m = 10.0;
const glm::dvec3 kMiddle(0.0, 40.0, kEyeHeight_m);

class Terminator : public TemporaryFolder {
 protected:
  /// A ball of triangles 12 degrees wide, 40 m north of the eye.
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
    WriteText(folder_ / "ball.obj", text);
    scene_ = BareScene(kEyeHeight_m, 0.0, 0.0, 32.0);
    scene_.terrain.kind = TerrainSource::Kind::kMesh;
    scene_.terrain.file = folder_ / "ball.obj";
  }

  static std::string VertexAt(double polar, double turn) {
    const glm::dvec3 up(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                        std::cos(polar));
    const glm::dvec3 at = kMiddle + kRadius_m * up;
    return fmt::format("v {:.9} {:.9} {:.9}\n", at.x, at.y, at.z);
  }

  /// The normal of the ball where a ray from the eye meets it well within its outline.
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

// Cosines below which a triangle is taken for the ball: its plane lies 0.006 radii below, which a
// ray that meets it at 25 degrees sees 0.013 radii aside.
constexpr double kEdge = 0.03;

TEST_F(Terminator, SunlightEndsWhereTheRoundBodyTurnsAway) {
  const SceneRenderer renderer(scene_);
  const CameraSample evening(ParseInstant("2026-06-21T17:30:00Z"));
  const RenderSettings settings{.width = 96,
                                .height = 54,
                                .samples_per_pixel = 1,
                                .air_nodes = 4,
                                .layers = {PictureLayer::kSunVisibility}};
  const Image picture = renderer.Render(evening, settings);
  const SunPosition sun = renderer.ApparentSun(evening);
  const glm::dvec3 to_sun = DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz;
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
  Light lamp;
  lamp.latitude_rad = scene_.place.latitude_rad;
  lamp.longitude_rad = scene_.place.longitude_rad + 100.0 / 4.4e6;  // 100 m east
  lamp.height = {kEyeHeight_m + 60.0, false};  // the edge of shade lies across rows of triangles
  lamp.intensity_cd = 1000.0;
  scene_.lights = {lamp};
  const SceneGround ground = LoadGround(scene_);
  const Medium medium = OnOsculatingSphere(scene_.medium, scene_.place.latitude_rad);
  const BandColour colour(medium.wavelengths_nm);
  const LampLight light(scene_, ground, medium, colour);
  const glm::dvec3 from = light.At(0).lamp.position_m;
  const CameraRays camera(scene_.camera, 96, 54);
  int near_the_edge = 0;
  for (int y = 0; y < 54; ++y) {
    for (int x = 0; x < 96; ++x) {
      const glm::dvec3 direction = camera.Direction(x + 0.5, y + 0.5);
      if (!NormalAt(direction)) continue;
      const auto hit = ground.terrain->Intersect({0.0, 0.0, kEyeHeight_m}, direction);
      ASSERT_TRUE(hit);
      const glm::dvec3 point = glm::dvec3(0.0, 0.0, kEyeHeight_m) + hit->distance_m * direction;
      const glm::dvec3 way = from - point;
      const double cosine = glm::dot(hit->normal, glm::normalize(way));
      if (!(cosine > kEdge && cosine < 0.1)) continue;
      ++near_the_edge;
      const Bands<float> seen =
          light.OnSurface({0}, {point, hit->smooth_point, hit->normal, hit->geometric_normal});
      const double facing = static_cast<double>(light.At(0).intensity[0]) / glm::dot(way, way);
      EXPECT_NEAR(static_cast<double>(seen[0]) / facing, cosine, 0.003)
          << x << ", " << y << ": 100 m of air take a part of the cosine and glow as much";
    }
  }
  EXPECT_GT(near_the_edge, 30);
}

}  // namespace
}  // namespace alpenglow::renderer
