// SPDX-License-Identifier: MIT
// Lamps in a picture: their light in the air from a lattice and from their cores, against that of
// every pixel; lamps themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "atmosphere/ray/shell.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/material/band_light.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

using LampPicture = tests::Headless;

constexpr int kWidth = 320, kHeight = 180;
constexpr double kHalfWidth = 0.45;  // tangent of half the field of view
constexpr double kLampPixel_rad = 2.0 * kHalfWidth / kWidth;

constexpr const char* kStage = R"(
in vec2 screen;
out vec4 picture;
void main() {
  vec3 direction = normalize(view_forward.xyz + screen.x * view_right.xyz + screen.y * view_up.xyz);
  picture = vec4(LampAirlightRgb(direction, LampRayEnd(direction, 0.0)), 1.0);
}
)";

/// A runway's edge in light fog before an eye that looks north from its end.
Scene Runway() {
  Scene scene = BareScene(6.0, 0.0, 0.0, 40.0);
  for (int i = 0; i < 8; ++i) {
    Light light;
    light.latitude_rad = scene.place.latitude_rad + (80.0 + 60.0 * (i / 2)) / 6371e3;
    light.longitude_rad =
        scene.place.longitude_rad + (i % 2 == 0 ? 20.0 : -20.0) / (6371e3 * std::cos(0.81));
    light.height = {0.5, false};
    light.intensity_cd = 600.0;
    scene.lights.push_back(light);
  }
  Fog fog;
  fog.extinction_per_m = 0.004;
  fog.scale_height_m = 25.0;
  fog.base_height_m = 0.0;
  fog.phase = FogPhase(12.0);
  scene.fog = fog;
  return scene;
}

struct LampNight {
  Scene scene = Runway();
  SceneGround ground = LoadGround(scene);
  SceneLamps lamps{scene, ground, scene.medium};

  [[nodiscard]] Image Paint(const LampQuality& quality) {
    const GlBuffer view_buffer;
    ViewBlock view{};
    view.view_right = {kHalfWidth, 0.0, 0.0, 0.0};
    view.view_up = {0.0, 0.0, kHalfWidth * kHeight / kWidth, 0.0};
    view.view_forward = {0.0, 1.0, 0.0, 0.0};
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, view_buffer.id());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(view), &view, GL_STATIC_DRAW);
    const RenderTarget surface(kWidth, kHeight, RenderTarget::Depth::kNone);
    surface.Bind();
    glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    LampPainter painter(lamps, quality, {});
    painter.Prepare(lamps, {{0.0, 0.0, 6.0}, glm::dmat3(1.0), 6.0, kLampPixel_rad}, 0.0);
    std::vector<ShaderPiece> texts =
        WithViewerPieces(SharedTexts(), {"viewer/shaders/view.block.glsl"});
    texts.insert(texts.end(), painter.texts().begin(), painter.texts().end());
    texts.push_back({"stage", kStage});
    const ShaderProgram program = FullScreenProgram(texts);
    painter.Connect(program);
    surface.BindTexture(0);
    painter.PaintGlow(kWidth, kHeight);
    const RenderTarget picture(kWidth, kHeight, RenderTarget::Depth::kNone);
    picture.Bind();
    painter.Bind();
    DrawFullScreen(program, GlVertexArray());
    painter.PaintOver(kLampPixel_rad);
    return picture.Read();
  }
};

glm::dvec3 DirectionOf(int x, int y) {
  const double right = kHalfWidth * ((2.0 * x + 1.0) / kWidth - 1.0);
  const double up = kHalfWidth * (kHeight - 2.0 * y - 1.0) / kWidth;
  return glm::normalize(glm::dvec3(right, 1.0, up));
}

/// By every third pixel each way.
std::vector<double> Deviations(const Image& image,
                               const std::function<double(int x, int y)>& truth) {
  std::vector<double> deviations;
  for (int y = 1; y < kHeight; y += 3) {
    for (int x = 1; x < kWidth; x += 3) {
      deviations.push_back(std::abs(double{image.at(x, y)[1]} / truth(x, y) - 1.0));
    }
  }
  std::sort(deviations.begin(), deviations.end());
  return deviations;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST_F(LampPicture, LampsAndTheirGlowAreThoseOfTheRendererPixelByPixel) {
  LampNight night;
  const BandColour colour(night.scene.medium.wavelengths_nm);
  const LampLight light(night.scene, night.ground, night.scene.medium, colour);
  const auto truth = [&](int x, int y) {
    const glm::dvec3 direction = DirectionOf(x, y);
    LampRayEnd end{direction, std::numeric_limits<double>::infinity()};
    if (direction.z < -2e-3) {
      const double h = 6e-3, radius = night.scene.medium.planet_radius_m / 1000.0;
      end.length_m = 1e3 * shared::DistanceDownTo(h, direction.z, 0.0, radius);
    }
    const CameraRay ray{{0.0, 0.0, 6.0}, {0.0, 0.0, 6.0}, direction, direction};
    const Bands<float> sum = light.InAir(light.All(), end, kLampPixel_rad, 32) +
                             light.Seen(light.All(), ray, kLampPixel_rad);
    const std::vector<double> values(sum.value.begin(), sum.value.begin() + 4);
    return colour.LinearSrgb(values)[1];
  };
  const std::vector<double> deviations = Deviations(night.Paint({.nodes = 12, .step = 1}), truth);
  EXPECT_LT(Mean(deviations), 5e-3);
  EXPECT_LT(deviations[deviations.size() * 999 / 1000], 0.02);
}

TEST_F(LampPicture, ALatticeOfEverySecondPixelWithCoresIsTheWholePicture) {
  LampNight night;
  const Image whole = night.Paint({.nodes = 12, .step = 1});
  const std::vector<double> deviations =
      Deviations(night.Paint({.nodes = 12, .step = 2}),
                 [&](int x, int y) { return double{whole.at(x, y)[1]}; });
  EXPECT_LT(deviations[deviations.size() / 2], 2e-3);
  EXPECT_LT(Mean(deviations), 0.015);
  EXPECT_LT(deviations[deviations.size() * 99 / 100], 0.02)
      << "two pixels here are eight of a picture of 720 lines";
}

}  // namespace
}  // namespace alpenglow::viewer
