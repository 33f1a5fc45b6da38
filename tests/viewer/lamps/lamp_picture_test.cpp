// SPDX-License-Identifier: MIT
// Lamps in a picture: their light in the air from a lattice and from their cores, against that of
// every pixel; lamps themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/fixtures/bare_scene.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/embedded_text.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/paint/uniform_blocks.h"

namespace alpenglow {
namespace {

using LampPicture = tests::Headless;

constexpr int kWidth = 320, kHeight = 180;
constexpr double kHalfWidth = 0.45;  // tangent of half the field of view
constexpr double kPixel_rad = 2.0 * kHalfWidth / kWidth;

constexpr const char* kStage = R"(
in vec2 screen;
out vec4 picture;
void main() {
  vec3 direction = normalize(view_forward.xyz + screen.x * view_right.xyz + screen.y * view_up.xyz);
  picture = vec4(LampGlowRgb(direction, LampRayEnd(direction, 0.0)), 1.0);
}
)";

ShaderPiece Piece(const char* name) { return {name, std::string(viewer::EmbeddedText(name))}; }

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

struct Night {
  Scene scene = Runway();
  SceneGround ground = LoadGround(scene);
  SceneLamps lamps{scene, ground, scene.medium};

  [[nodiscard]] Image Paint(const LampQuality& quality, bool with_disks = false) {
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
    painter.Prepare(lamps, {{0.0, 0.0, 6.0}, glm::dmat3(1.0), 6.0, kPixel_rad}, 0.0);
    std::vector<ShaderPiece> texts = SharedTexts();
    texts.push_back(Piece("viewer/shaders/view_block.glsl"));
    texts.insert(texts.end(), painter.texts().begin(), painter.texts().end());
    texts.push_back({"stage", kStage});
    const ShaderProgram program({Piece("viewer/shaders/full_screen.vert.glsl")}, texts);
    painter.Connect(program);
    surface.BindTexture(0);
    painter.PaintGlow(kWidth, kHeight);
    const RenderTarget picture(kWidth, kHeight, RenderTarget::Depth::kNone);
    picture.Bind();
    painter.Bind();
    program.Use();
    const GlVertexArray no_vertices;
    glBindVertexArray(no_vertices.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if (!with_disks) glEnable(GL_RASTERIZER_DISCARD);
    glDisable(GL_RASTERIZER_DISCARD);
    painter.PaintOver(kPixel_rad);
    return picture.Read();
  }
};

double Sum(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) sum += double{image.At(x, y)[1]};
  }
  return sum;
}

TEST_F(LampPicture, ALatticeOfEveryFourthPixelWithCoresIsTheWholePicture) {
  Night night;
  const Image whole = night.Paint({.nodes = 12, .step = 1});
  const Image coarse = night.Paint({.nodes = 12, .step = 4});
  std::vector<double> deviations;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double truth = double{whole.At(x, y)[1]};
      deviations.push_back(std::abs(double{coarse.At(x, y)[1]} / truth - 1.0));
    }
  }
  std::sort(deviations.begin(), deviations.end());
  EXPECT_LT(deviations[deviations.size() / 2], 1e-3);
  EXPECT_LT(deviations[deviations.size() * 99 / 100], 0.02) << "a pixel here is three of 720 lines";
}

}  // namespace
}  // namespace alpenglow
