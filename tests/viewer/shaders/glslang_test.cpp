// SPDX-License-Identifier: MIT
// The shaders, read by a second compiler: Khronos' reference front end is stricter than Mesa, and
// drivers are as strict as it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "renderer/surface/scene_ground.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/viewer/ground/sun_in_closed_form.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/ground/ground_block.h"
#include "viewer/lamps/fog.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/land/land_pass.h"
#include "viewer/passes/display_pass.h"
#include "viewer/passes/picture_programs.h"
#include "viewer/passes/tone_map_pass.h"
#include "viewer/shade/shafts.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
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
    texts.push_back(ViewerPiece("viewer/shaders/" + stage));
    ExpectTextAccepted(texts, std::filesystem::path(stage).filename());
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

TEST_F(Glslang, AcceptsTheShadersOfLandShaftsAndDisplay) {
  ShaderPiece view = ViewerPiece("viewer/shaders/view.block.glsl");
  ExpectAccepted({}, "view.full_screen.vert.glsl");
  ExpectAccepted({}, "hud.vert.glsl");
  ExpectAccepted({}, "hud.frag.glsl");
  for (int curve = 0; curve < 5; ++curve) {
    for (const bool dithers : {false, true})
      ExpectAccepted(ToneMapPassTexts(static_cast<ToneCurve>(curve), dithers),
                     "display.tone_map.frag.glsl");
  }
  const ShaderPiece single = {
      "air",
      "vec4 SingleTo(vec3 direction, float km) { return vec4(km * direction.z); }\n"
      "vec4 SkyRadiance(vec3 direction) { return vec4(direction.z); }\n"};
  ExpectAccepted(ShaftPassTexts({view, single}, false), "shafts.frag.glsl");
  std::vector<ShaderPiece> in_fog =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/view.block.glsl"});
  in_fog.push_back(single);
  for (ShaderPiece& piece : FogTexts(PhaseKind::kHenyeyGreenstein))
    in_fog.push_back(std::move(piece));
  ExpectAccepted(ShaftPassTexts(std::move(in_fog), true), "shafts.frag.glsl");
  std::vector<ShaderPiece> land = SharedTexts();
  land.push_back(view);
  land.push_back(ViewerPiece("viewer/shaders/view.refracted_rays.glsl"));
  land.push_back(ViewerPiece("viewer/shaders/land.block.glsl"));
  ExpectAccepted(land, "land.vert.glsl");
  for (const char* depth : {"reversed", "logarithmic"}) {
    const ShaderPiece depth_text =
        ViewerPiece(fmt::format("viewer/shaders/gbuffer.{}_depth.glsl", depth));
    for (const char* drawn : {"land.frag.glsl", "land.depth_prepass.frag.glsl"})
      ExpectAccepted(LandTexts(depth_text), drawn);
    for (const auto shows : {Upscaler::Shows::kCodes, Upscaler::Shows::kLight})
      ExpectAccepted(UpscalerTexts(shows, depth_text), "display.upscale.frag.glsl");
  }
}

/// A bare scene with a lamp, and perhaps fog.
Scene LampScene(bool with_fog) {
  Scene scene = BareScene(10.0, 0.0, 0.0, 40.0);
  scene.lights.emplace_back();
  scene.lights.back().latitude_rad = scene.place.latitude_rad;
  scene.lights.back().longitude_rad = scene.place.longitude_rad;
  scene.lights.back().height = {5.0, false};
  scene.lights.back().intensity_cd = 1000.0;
  if (!with_fog) return scene;
  scene.fog.emplace();
  scene.fog->extinction_per_m = 0.01;
  scene.fog->scale_height_m = 30.0;
  scene.fog->base_height_m = 0.0;
  return scene;
}

TEST_F(Glslang, AcceptsTheShadersOfLampsWithAndWithoutFog) {
  for (const bool with_fog : {false, true}) {
    const Scene scene = LampScene(with_fog);
    const SceneLamps lamps(scene, LoadGround(scene), scene.medium);
    std::vector<ShaderPiece> texts = SharedTexts();
    texts.push_back(ViewerPiece("viewer/shaders/view.block.glsl"));
    std::vector<ShaderPiece> corners = texts;
    const std::vector<ShaderPiece> of_lamps = LampTexts(lamps, {.nodes = 6, .step = 4});
    texts.insert(texts.end(), of_lamps.begin(), of_lamps.end());
    corners.insert(corners.end(), of_lamps.begin(),
                   of_lamps.end() - 1);  // the last is of pixels
    corners.push_back(ViewerPiece("viewer/shaders/lamps.corners.glsl"));
    ExpectAccepted(corners, "lamps.core.vert.glsl");
    ExpectAccepted(corners, "lamps.disk.vert.glsl");
    for (const char* stage :
         {"lamps.airlight.frag.glsl", "lamps.core.frag.glsl", "lamps.disk.frag.glsl"}) {
      ExpectAccepted(texts, stage);
    }
  }
}

TEST_F(Glslang, AcceptsEveryStageOfThePicture) {
  const std::unique_ptr<HeadlessContext> context = tests::ContextOrNone();
  if (!context) GTEST_SKIP() << "EGL gives no OpenGL here";
  for (const bool with_fog : {false, true}) {
    const Scene scene = LampScene(with_fog);
    const SceneLamps lamps(scene, LoadGround(scene), scene.medium);
    const LampPainter painter(lamps, kMediumLamps, {});
    const GroundMaterial material(scene.ground, nullptr, scene.medium.wavelengths_nm);
    const auto fog = with_fog ? std::optional(PhaseKind::kHenyeyGreensteinDraine) : std::nullopt;
    for (const auto pass : {PictureStage::Pass::kLand, PictureStage::Pass::kSky,
                            PictureStage::Pass::kOccludedSky, PictureStage::Pass::kDisks}) {
      for (int choice = 0; choice < 4; ++choice) {
        const PictureStage stage{pass, choice % 2 == 1, choice / 2 == 1};
        ExpectAccepted(PictureTexts({material, painter, {true, true}, fog}, stage),
                       "picture.frag.glsl");
      }
    }
  }
}

TEST_F(Glslang, AcceptsEveryCoverOfTheGround) {
  for (const auto kind :
       {GroundCover::Kind::kMountain, GroundCover::Kind::kLambert, GroundCover::Kind::kOrenNayar,
        GroundCover::Kind::kBlinnPhong, GroundCover::Kind::kWater, GroundCover::Kind::kSnow}) {
    GroundCover cover;
    cover.kind = kind;
    if (kind == GroundCover::Kind::kLambert) cover.sea_level_m = 0.0;
    std::vector<ShaderPiece> texts = WithViewerPieces(
        SharedTexts(), {"viewer/shaders/air.block.glsl", "viewer/shaders/view.block.glsl",
                        "viewer/shaders/air.sun_light.glsl"});
    texts.push_back(tests::SunInClosedForm());
    const std::vector<double> bands{450.0, 550.0, 650.0};
    for (ShaderPiece& piece :
         GroundTexts(GroundMaterial(cover, nullptr, bands),
                     {!cover.sea_level_m, kind != GroundCover::Kind::kOrenNayar}))
      texts.push_back(std::move(piece));
    texts.push_back({"main",
                     "out vec4 sent;\nvoid main() {\n  vec3 p = gl_FragCoord.xyz;\n  sent = "
                     "GroundRadiance(p, p, 1.0, vec4(1.0), p) + PlanetRadiance(p, p);\n}\n"});
    ExpectTextAccepted(texts, "ground.frag.glsl");
  }
}

TEST_F(Glslang, RefusesABrokenShader) {
  WriteText(folder_ / "broken.frag", "#version 330 core\nvoid main() { nonsense; }\n");
  const std::string command =
      "glslangValidator " + (folder_ / "broken.frag").string() + " >/dev/null";
  EXPECT_NE(WEXITSTATUS(std::system(command.c_str())), 0);
}

}  // namespace
}  // namespace alpenglow::viewer
