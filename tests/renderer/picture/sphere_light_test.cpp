// SPDX-License-Identifier: MIT
// Spheres of a scene: their places, and pictures of and through them.
#include "renderer/picture/sphere_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

const UtcTime kMorning = ParseInstant("2026-06-21T06:00:00Z");

/// A sphere 10 m to the north of the camera of BareScene.
SceneObject BallAhead(double underside_m) {
  SceneObject ball;
  ball.name = "s.toml: object[0]";
  ball.place = {46.50009, 8.0, 0.0};
  ball.height = {underside_m, false};
  ball.photons = 2000.0;
  return ball;
}

HdrImage Pictured(const Scene& scene) {
  RenderSettings settings;
  settings.width = 24;
  settings.height = 16;
  settings.samples_per_pixel = 1;
  return SceneRenderer(scene).Render(kMorning, settings);
}

double LuminanceAt(const HdrImage& image, std::size_t column, std::size_t row) {
  return tests::Luminance(image.rgb[row * 24 + column]);
}

/// Returns whether the sky is above the ground in the middle of a picture: the sky is bluer.
bool SkyIsAbove(const HdrImage& image) {
  const auto blue = [&](std::size_t row) {
    const std::array<float, 3>& rgb = image.rgb[row * 24 + 12];
    return rgb[2] / rgb[0];
  };
  return blue(5) > 1.05F * blue(10);
}

TEST(SphereLight, SpheresStandAtTheirHeights) {
  Scene scene = BareScene(1.7, 0.0, 0.0, 30.0);
  scene.objects = {BallAhead(0.5), BallAhead(0.0)};
  scene.objects[1].height = {3.0, true};
  scene.objects[1].radius_m = 2.0;
  const std::vector<SpecularSphere> spheres = SpheresOf(scene, LoadGround(scene));
  // A ten-thousandth of a degree of latitude is 11.1 m; the earth falls by 8 micrometres.
  EXPECT_LT(glm::length(spheres[0].centre - glm::dvec3(0.0, 10.0, 1.5)), 0.02);
  EXPECT_LT(glm::length(spheres[1].centre - glm::dvec3(0.0, 10.0, 5.0)), 0.02);
}

TEST(SphereLight, RefusesSpheresBelowTheGround) {
  Scene scene = BareScene(1.7, 0.0, 0.0, 30.0);
  scene.objects = {BallAhead(-5.0)};
  EXPECT_THAT(tests::FaultOf([&] { return SpheresOf(scene, LoadGround(scene)); }),
              HasSubstr("s.toml: object[0].height_m is -5; the ground there is at 0.0 m"));
}

TEST(SphereLight, GlassWithTheIndexOfAirIsNotSeen) {
  Scene scene = QuickScene(1.7, 0.0, 0.0, 30.0);
  const HdrImage empty = Pictured(scene);
  scene.objects = {BallAhead(0.7)};
  scene.objects[0].index = 1.0;
  const HdrImage ball = Pictured(scene);
  // The last row is left out: light through the sphere, which takes the place of its shadow, has noise.
  for (std::size_t i = 0; i < empty.rgb.size() - 24; ++i) {
    // The air behind the sphere is taken from the eye: 10 m of air more, 1e-3 of the light.
    EXPECT_NEAR(tests::Luminance(ball.rgb[i]), tests::Luminance(empty.rgb[i]),
                3e-3 * tests::Luminance(empty.rgb[i]))
        << i % 24 << " " << i / 24;
  }
}

// The camera looks down at the shadow of a sphere 3 m towards the sun. 5000 photons have 90 in the
// disk of a spot: a noise of 13 % of direct light in a pixel, and less in the mean of many.
TEST(SphereLight, GlassWithTheIndexOfAirCastsNoShadow) {
  Scene scene = QuickScene(1.7, 0.0, -89.0, 50.0);
  const HdrImage empty = Pictured(scene);
  scene.objects = {BallAhead(0.5)};
  scene.objects[0].place = {46.5, 8.00004, 0.0};
  scene.objects[0].photons = 5000.0;
  const double with_light = tests::MeanLuminance(empty);
  scene.objects[0].index = 1.0;
  EXPECT_NEAR(tests::MeanLuminance(Pictured(scene)), with_light, 0.02 * with_light);
  scene.objects[0].material = SphereMaterial::kMirror;
  EXPECT_LT(tests::MeanLuminance(Pictured(scene)), 0.9 * with_light)
      << "a mirror throws its light elsewhere";
}

TEST(SphereLight, GlassShowsTheSceneUpsideDownAndAMirrorDoesNot) {
  Scene scene = QuickScene(1.7, 0.0, 0.0, 20.0);
  EXPECT_TRUE(SkyIsAbove(Pictured(scene)));
  scene.objects = {BallAhead(0.7)};
  EXPECT_FALSE(SkyIsAbove(Pictured(scene)));
  scene.objects[0].material = SphereMaterial::kMirror;
  EXPECT_TRUE(SkyIsAbove(Pictured(scene)));
}

/// Returns the fog around the camera, in which a sphere has a caustic.
Scene FogForCaustics() {
  Scene scene = QuickScene(1.7, 0.0, 0.0, 30.0);
  scene.layers.resize(1);
  scene.layers[0].extinction_per_m = 0.02;
  scene.layers[0].scale_height_m = 10.0;
  scene.layers[0].base_height_m = 0.0;
  scene.layers[0].phase.kind = PhaseKind::kHenyeyGreenstein;
  scene.layers[0].phase.g = 0.3;
  return scene;
}

TEST(SphereLight, ACausticBrightensTheFogBesideTheSphere) {
  // The sun is in the east, and the focus is to the west of the sphere.
  Scene scene = FogForCaustics();
  const HdrImage empty = Pictured(scene);
  scene.objects = {BallAhead(0.7)};
  const HdrImage ball = Pictured(scene);
  double brighter = 0.0;
  for (std::size_t column = 4; column < 7; ++column) {
    for (std::size_t row = 7; row < 11; ++row) {
      const double gain = LuminanceAt(ball, column, row) / LuminanceAt(empty, column, row) - 1.0;
      EXPECT_GE(gain, -1e-6) << column << " " << row;
      brighter = std::max(brighter, gain);
    }
  }
  EXPECT_GT(brighter, 0.003);
}

// Both maps have the light of the same photons. 2000 points leave a noise of a tenth in the sum, and
// their wider kernel moves light over the border of the part that is compared.
TEST(SphereLight, PointsHaveTheLightOfBeams) {
  Scene scene = FogForCaustics();
  const HdrImage empty = Pictured(scene);
  scene.objects = {BallAhead(0.7)};
  scene.objects[0].photons = 20000.0;
  const auto caustic = [&](PhotonMap map) {
    scene.objects[0].photon_map = map;
    const HdrImage image = Pictured(scene);
    double sum = 0.0;
    for (std::size_t column = 0; column < 9; ++column) {
      for (std::size_t row = 4; row < 13; ++row)
        sum += LuminanceAt(image, column, row) - LuminanceAt(empty, column, row);
    }
    return sum;
  };
  const double beams = caustic(PhotonMap::kBeams);
  EXPECT_GT(beams, 0.0);
  EXPECT_NEAR(caustic(PhotonMap::kPoints) / beams, 1.0, 0.15);
}

}  // namespace
}  // namespace alpenglow::renderer
