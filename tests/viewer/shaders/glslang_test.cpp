// SPDX-License-Identifier: MIT
// The shaders, read by a second compiler: Khronos' reference front end is stricter than Mesa, and
// drivers are as strict as it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"
#include "viewer/embedded_text.h"
#include "viewer/lamps/fog_painter.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/ground/ground_block.h"
#include "viewer/paint/sky_painter.h"

namespace alpenglow {
namespace {

class Glslang : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    if (std::system("glslangValidator --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "glslangValidator (glslang-tools) is not installed";
    }
  }
  /// Checks `stage`, a file of the viewer named "....vert.glsl" or "....frag.glsl", after `texts`.
  void ExpectAccepted(std::vector<ShaderPiece> texts, const std::string& stage) const {
    texts.push_back({stage, std::string(viewer::EmbeddedText("viewer/shaders/" + stage))});
    ExpectTextAccepted(texts, stage);
  }
  void ExpectTextAccepted(const std::vector<ShaderPiece>& texts, const std::string& stage) const {
    const std::filesystem::path file =
        folder_ / stage.substr(0, stage.size() - std::string(".glsl").size());
    WriteText(file, ComposeShader(texts));
    const std::filesystem::path log = folder_ / "log";
    const int status =
        std::system(("glslangValidator " + file.string() + " >" + log.string()).c_str());
    EXPECT_EQ(WEXITSTATUS(status), 0) << NamePieces(ContentOf(log), texts);
  }
};

TEST_F(Glslang, AcceptsEveryShaderOfTheViewer) {
  const ShaderPiece view{"viewer/shaders/view_block.glsl",
                         std::string(viewer::EmbeddedText("viewer/shaders/view_block.glsl"))};
  ExpectAccepted(LightTexts(4), "picture.frag.glsl");
  ExpectAccepted(LightTexts(2), "diffuse_sky.frag.glsl");
  ExpectAccepted(SharedTexts(), "develop.frag.glsl");
  ExpectAccepted({view}, "terrain.vert.glsl");
  const ShaderPiece air{"air",
                        "vec4 SingleTo(vec3 direction, float distance_km) {\n"
                        "  return vec4(distance_km * direction.z);\n}\n"};
  std::vector<ShaderPiece> shafts = {view, air};
  for (const char* name : {"viewer/shaders/shade_march.glsl", "viewer/shaders/shaft_texel.glsl"})
    shafts.push_back({name, std::string(viewer::EmbeddedText(name))});
  ExpectAccepted(shafts, "shafts.frag.glsl");
  const auto piece = [](const std::string& name) {
    return ShaderPiece{name, std::string(viewer::EmbeddedText(name))};
  };
  ExpectAccepted({view, piece("viewer/shaders/land_block.glsl")}, "land.vert.glsl");
  for (const char* depth : {"reversed", "logarithmic"}) {
    ExpectAccepted(
        {piece("viewer/shaders/land_block.glsl"), piece("viewer/shaders/octahedral.glsl"),
         piece(fmt::format("viewer/shaders/{}_depth.glsl", depth))},
        "land.frag.glsl");
  }
  for (const char* stage : {"average.frag.glsl", "empty.frag.glsl", "full_screen.vert.glsl",
                            "shadow.vert.glsl", "terrain.frag.glsl"}) {
    ExpectAccepted({}, stage);
  }
}

TEST_F(Glslang, AcceptsTheShadersOfLampsWithAndWithoutFog) {
  for (const bool with_fog : {false, true}) {
    Scene scene = BareScene(10.0, 0.0, 0.0, 40.0);
    if (with_fog) {
      scene.fog.emplace();
      scene.fog->extinction_per_m = 0.01;
      scene.fog->scale_height_m = 30.0;
      scene.fog->base_height_m = 0.0;
    }
    const SceneGround ground = LoadGround(scene);
    const SceneLamps lamps(scene, ground, scene.medium);
    std::vector<ShaderPiece> texts = SharedTexts();
    texts.push_back({"viewer/shaders/view_block.glsl",
                     std::string(viewer::EmbeddedText("viewer/shaders/view_block.glsl"))});
    for (const ShaderPiece& piece : LampTexts(lamps, {.nodes = 6, .step = 4}))
      texts.push_back(piece);
    for (const char* stage :
         {"lamp_glow.frag.glsl", "lamp_core.frag.glsl", "lamp_disk.frag.glsl"}) {
      ExpectAccepted(texts, stage);
    }
TEST_F(Glslang, AcceptsEveryCoverOfTheGround) {
  for (const auto kind :
       {GroundCover::Kind::kMountain, GroundCover::Kind::kLambert, GroundCover::Kind::kOrenNayar,
        GroundCover::Kind::kBlinnPhong, GroundCover::Kind::kWater, GroundCover::Kind::kSnow}) {
    GroundCover cover;
    cover.kind = kind;
    if (kind == GroundCover::Kind::kLambert) cover.sea_level_m = 0.0;
    std::vector<ShaderPiece> texts = SharedTexts();
    for (const char* name :
         {"viewer/shaders/air_block.glsl", "viewer/shaders/view_block.glsl",
          "viewer/shaders/sun_light.glsl", "viewer/shaders/sun_transmittance.glsl"})
      texts.push_back({name, std::string(viewer::EmbeddedText(name))});
    const std::vector<double> bands{450.0, 550.0, 650.0};
    for (ShaderPiece& piece : GroundTexts(GroundMaterial(cover, nullptr, bands)))
      texts.push_back(std::move(piece));
    texts.push_back({"main",
                     "out vec4 sent;\nvoid main() {\n  vec3 p = gl_FragCoord.xyz;\n  sent = "
                     "GroundRadiance(p, p, 1.0, vec4(1.0), p) + PlanetRadiance(p, p);\n}\n"});
    ExpectTextAccepted(texts, "ground.frag.glsl");
  }
}

TEST_F(Glslang, AcceptsWhatStandsForFogAndLampsWhereThereAreNone) {
  const Scene scene = BareScene(10.0, 0.0, 0.0, 40.0);
  const SceneGround ground = LoadGround(scene);
  const SceneLamps lamps(scene, ground, scene.medium);
  const std::vector<ShaderPiece> fog = FogTexts(PhaseKind::kHenyeyGreensteinDraine);
  // The calls of a picture.
  const ShaderPiece use{"use", R"(
vec4 Use(vec3 direction, float km) {
  FogAlong fog = FogTo(direction, km);
  FogStretches stretches = FogStretchesTo(direction, km);
  vec4 sum = fog.radiance + FogSunTo(direction, km) + FogOnSurface(km, 1.0);
  for (int i = 0; i < FOG_STRETCHES; ++i) sum += stretches.weight[i] * stretches.distance_km[i];
  sum += LampsOnGround(direction, direction) * FogSunLeft(km, 0.5) * FogSkyLeft(km);
  return sum + vec4(LampRgb(sum) + LampGlowRgb(direction, km), FogTransmittance(direction, km));
}
)"};
  for (const auto& lights : {NoLampTexts(), LampTexts(lamps, kMediumLamps)}) {
    for (const auto& fogs : {NoFogTexts(), fog}) {
      std::vector<ShaderPiece> texts = SharedTexts();
      texts.insert(texts.end(), lights.begin(), lights.end());
      texts.insert(texts.end(), fogs.begin(), fogs.end());
      texts.push_back(use);
      ExpectAccepted(texts, "empty.frag.glsl");
    }
  }
}

TEST_F(Glslang, RefusesABrokenShader) {
  WriteText(folder_ / "broken.frag", "#version 330 core\nvoid main() { nonsense; }\n");
  const std::string command =
      "glslangValidator " + (folder_ / "broken.frag").string() + " >/dev/null";
  EXPECT_NE(WEXITSTATUS(std::system(command.c_str())), 0);
}

}  // namespace
}  // namespace alpenglow
