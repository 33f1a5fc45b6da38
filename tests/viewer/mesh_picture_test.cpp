// SPDX-License-Identifier: MIT
// Meshes of files in both programs: small ones, far ones, flat ones, and what is under a roof.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lut/image/image.h"
#include "tests/fixtures/bare_scene_folder.h"
#include "tests/fixtures/obj_texts.h"
#include "tests/fixtures/places.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

using ::testing::HasSubstr;

class MeshPictures : public BareSceneFolder {
 protected:
  void SetUp() override {
    if (!tests::HasOpenGl()) GTEST_SKIP() << "EGL gives no OpenGL here";
    BareSceneFolder::SetUp();
  }

  /// A scene with the mesh m.obj of one colour, in air of three bands.
  void WriteScene(const std::string& mesh, const std::string& camera,
                  const std::string& utc = "2026-06-21T10:30:00Z",
                  const std::string& more = "") const {
    WriteText(folder_ / "m.obj", mesh);
    WriteText(folder_ / "m.toml",
              fmt::format("[place]\nlatitude = 46.5\nlongitude = 8.0\n[time]\nutc = \"{}\"\n"
                          "[camera]\n{}\n[terrain]\nmesh = \"m.obj\"\n[ground]\n"
                          "cover = \"lambert\"\nalbedo = [0.4, 0.4, 0.4]\n[atmosphere]\n"
                          "preset = \"bruneton2017\"\n{}",
                          utc, camera, more));
  }
  [[nodiscard]] Outcome RunViewer(const std::string& options = "") const {
    return RunCommand(
        fmt::format("env -u DISPLAY -u WAYLAND_DISPLAY '{}' m.toml --headless "
                    "--quality low --size 64x36 --screenshot v.exr {}",
                    tests::kSkyview, options));
  }
  [[nodiscard]] Outcome RunRenderer() const {
    return RunCommand(
        fmt::format("'{}' m.toml --size 64x36 --samples 4 --out s.exr", tests::kSkyseries));
  }
  void ExpectAlikeAt(int x, int y, double tolerance, const std::string& what) const {
    const Outcome viewer = RunViewer(), renderer = RunRenderer();
    ASSERT_EQ(viewer.status, 0) << what << viewer.error;
    ASSERT_EQ(renderer.status, 0) << what << renderer.error;
    const float drawn = ReadExr(folder_ / "v.exr").at(x, y)[1];
    const float wanted = ReadExr(folder_ / "s.exr").at(x, y)[1];
    EXPECT_GT(wanted, 0.0F) << what;
    EXPECT_NEAR(drawn, wanted, tolerance * static_cast<double>(wanted)) << what;
  }
};

TEST_F(MeshPictures, ASmallMeshIsLitAsTheRendererLightsIt) {
  WriteScene(tests::ObjOf({{20.0, 0.0}}), "height_m = 60.0\npitch = -90.0\nfov = 20.0");
  ExpectAlikeAt(32, 18, 0.05, "a square of 40 m ");
  WriteScene(tests::ObjOf({{0.3, 58.0}}), "height_m = 60.0\npitch = -90.0\nfov = 10.0");
  ExpectAlikeAt(32, 18, 0.05, "a square of 60 cm ");
}

TEST_F(MeshPictures, AMeshFarAwayIsLitAsTheRendererLightsIt) {
  for (const double km : {40.0, 72.0}) {
    WriteScene(tests::ObjOf({{5000.0, 1000.0, 0.0, 1e3 * km}}),
               fmt::format("height_m = 9000.0\nheading = 0.0\npitch = {}\nfov = 5.0",
                           -180.0 / 3.14159265 * std::atan2(8.0, km)));
    ExpectAlikeAt(32, 18, 0.08, fmt::format("{} km away ", km));
  }
}

TEST_F(MeshPictures, AReplayMayComeFromFarToTheMesh) {
  WriteScene(tests::ObjOf({{20.0, 0.0}}), "height_m = 60.0\npitch = -90.0\nfov = 20.0");
  WriteText(folder_ / "p.csv",
            "t_s,latitude,longitude,height_m,heading,pitch\n0,46.5,9,3000,270,-90\n"
            "10,46.5,8,60,270,-90\n");
  const Outcome outcome = RunCommand(
      fmt::format("env -u DISPLAY -u WAYLAND_DISPLAY '{}' m.toml --headless --quality low "
                  "--size 64x36 --replay p.csv --frames 2 --screenshot r.%d.exr",
                  tests::kSkyview));
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  ASSERT_EQ(RunViewer("--heading 270").status, 0);
  const float alone = ReadExr(folder_ / "v.exr").at(32, 18)[1];
  EXPECT_NEAR(ReadExr(folder_ / "r.1.exr").at(32, 18)[1], alone, 0.02F * alone);
}

TEST_F(MeshPictures, AFlatMeshHasNoReliefInEitherProgram) {
  WriteScene(tests::ObjOf({{2000.0, 0.0}}), "above_ground_m = 30.0\npitch = -20.0\nfov = 40.0",
             "2026-06-21T05:00:00Z");
  ExpectAlikeAt(32, 30, 0.05, "a plane ");
  for (const char* const name : {"v.exr", "s.exr"}) {
    const Image image = ReadExr(folder_ / name);
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (int y = 24; y < 36; ++y) {
      for (int x = 24; x < 40; ++x, ++count) {
        const auto value = static_cast<double>(image.at(x, y)[1]);
        sum += value;
        squares += value * value;
      }
    }
    const double mean = sum / count;
    EXPECT_LT(std::sqrt(std::max(squares / count - mean * mean, 0.0)), 0.02 * mean) << name;
  }
}

TEST_F(MeshPictures, UnderARoofACameraAndALampAreInTheOpen) {
  const std::string lamp =
      "[[light]]\nlatitude = 46.5\nlongitude = 8.0\nheight_m = 28.0\nintensity_cd = 5000.0\n";
  WriteScene(tests::RoofObj(), "height_m = 25.0\npitch = -30.0\nfov = 60.0", "2026-01-15T23:30:00Z",
             lamp);
  ExpectAlikeAt(32, 18, 0.1, "the floor in the light of the lamp ");
}

TEST_F(MeshPictures, BelowTheLowestSurfaceBothRefuseALamp) {
  const std::string lamp =
      "[[light]]\nlatitude = 46.5\nlongitude = 8.0\nheight_m = 19.0\nintensity_cd = 5000.0\n";
  WriteScene(tests::RoofObj(), "height_m = 40.0", "2026-01-15T23:30:00Z", lamp);
  for (const Outcome& outcome : {RunViewer(), RunRenderer()}) {
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.error, HasSubstr("light 1: height_m is 19; the ground there is at 20.0 m"));
  }
}

TEST_F(MeshPictures, BothProgramsSayWhatTheyLeaveOut) {
  WriteScene(tests::ObjOf({{20.0, 0.0}}) + "f 1 1 2\n", "above_ground_m = 30.0");
  for (const Outcome& outcome : {RunViewer(), RunRenderer()}) {
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.error, HasSubstr("1 face without area left out (the first in line 6)"));
  }
}

}  // namespace
}  // namespace alpenglow::viewer
