// SPDX-License-Identifier: MIT
// skyview in a window: the program itself on a display that follows a script
// (tests/fixtures/scripted_display.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "lut/image/image.h"
#include "lut/image/png.h"
#include "renderer/camera/camera_path.h"
#include "tests/fixtures/bare_scene_folder.h"
#include "tests/fixtures/places.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SkyviewWindow : public BareSceneFolder {
 protected:
  void SetUp() override {
    BareSceneFolder::SetUp();
    static const bool has_display = Run("ALPENGLOW_DISPLAY='8x8'", "").status == 0;
    if (!has_display) GTEST_SKIP() << "Mesa's EGL gives no OpenGL here";
  }
  /// @param display  as ALPENGLOW_DISPLAY and ALPENGLOW_DISPLAY_GL say it.
  [[nodiscard]] Outcome Run(const std::string& display, const std::string& arguments) const {
    return RunCommand("env " + display + " '" + tests::kSkyviewOnScriptedDisplay + "' s.toml " +
                      arguments);
  }
};

/// Sizes of the pictures that were shown. Each had light in its middle.
std::vector<std::string> Shown(const std::string& printed) {
  std::istringstream lines(printed);
  std::string word, size;
  std::vector<std::string> sizes;
  for (int red = 0, green = 0, blue = 0; lines >> word >> size >> red >> green >> blue;) {
    EXPECT_GT(red + green + blue, 60) << size;
    sizes.push_back(size);
  }
  return sizes;
}

// Hard case 49.
TEST_F(SkyviewWindow, ContinuesWhenMinimisedResizedOrMoved) {
  // The window opens, is minimised, moves to a display of twice the density, and shrinks to a pixel
  // and to a column.
  const Outcome outcome = Run("ALPENGLOW_DISPLAY='64x36 0x0 0x0 128x72 1x1 1x40'", "--hud off");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(Shown(outcome.out), ElementsAre("64x36", "128x72", "1x1", "1x40"))
      << "and nothing while it is minimised";
}

// Hard case 49.
TEST_F(SkyviewWindow, AScreenshotHasTheCurrentSizeOfTheWindow) {
  const Outcome outcome =
      Run("ALPENGLOW_DISPLAY='64x36 0x0 100x50 100x50'", "--frames 2 --screenshot shot.png");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  const DisplayImage image = ReadPng(folder_ / "shot.png");
  EXPECT_EQ(image.width, 100) << "the second picture that was shown";
  EXPECT_EQ(image.height, 50);
}

// Hard case 49.
TEST_F(SkyviewWindow, EndsNormallyWhenOpenedMinimised) {
  const Outcome outcome = Run("ALPENGLOW_DISPLAY='0x0 0x0'", "");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(Shown(outcome.out), ElementsAre());
}

// Hard case 49.
TEST_F(SkyviewWindow, OpenGl21ExitsWith5AndAClearMessage) {
  for (const char* newest : {"2.1", "3.2"}) {
    const Outcome outcome =
        Run(std::string("ALPENGLOW_DISPLAY=64x36 ALPENGLOW_DISPLAY_GL=") + newest,
            "--frames 1 --screenshot shot.png");
    EXPECT_EQ(outcome.status, 5) << newest;
    EXPECT_THAT(outcome.error, HasSubstr("no OpenGL 3.3 core context"));
    EXPECT_THAT(outcome.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "shot.png"));
  }
  const Outcome old = Run("ALPENGLOW_DISPLAY=64x36 ALPENGLOW_DISPLAY_GL=3.3", "");
  EXPECT_EQ(old.status, 0) << "3.3 is enough; " << old.error;
}

/// A display of so many equal pictures, with a word before the last one.
std::string DisplayWith(const std::string& word) {
  std::string script;
  for (int i = 0; i < 4; ++i) script += "16x9 ";
  return "ALPENGLOW_DISPLAY='" + script + word + " 16x9'";
}

TEST_F(SkyviewWindow, ASignalOrALostDisplayLeavesACompleteRecord) {
  struct Case {
    const char* word;
    int status;
    const char* said;
  };
  for (const Case& c : {Case{"raise:2", 130, ""}, Case{"raise:15", 143, ""}, Case{"raise:1", 0, ""},
                        Case{"gone", 5, "display has gone"}, Case{"reset", 5, "was reset"}}) {
    std::filesystem::remove(folder_ / "f.csv");
    const Outcome outcome = Run(DisplayWith(c.word), "--record f.csv");
    EXPECT_EQ(outcome.status, c.status) << c.word << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(c.said));
    EXPECT_GE(ReadCameraPath(folder_ / "f.csv").points().size(), 1U) << c.word;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "f.csv.part")) << c.word;
  }
}

TEST_F(SkyviewWindow, AFlightEndingBeforeItsLandLoadsReportsNoRecord) {
  WriteText(folder_ / "s.toml",
            "[place]\nlatitude = 46.5\nlongitude = 8.0\n[terrain]\nrange = true\n"
            "[atmosphere]\npreset = \"bruneton2017\"\n");
  const Outcome outcome = Run("ALPENGLOW_DISPLAY='16x9'", "--record f.csv --altitude 2500");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("f.csv is not written: nothing was flown"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.csv.part"));
}

TEST_F(SkyviewWindow, ReplaysAFlightThatWasKilled) {
  const Outcome killed = Run(DisplayWith("raise:9"), "--record f.csv");
  EXPECT_NE(killed.status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.csv"));
  const std::string replay = "--headless --size 16x9 --screenshot last.png --replay ";
  const Outcome missing = Run("ALPENGLOW_DISPLAY=8x8", replay + "f.csv");
  EXPECT_EQ(missing.status, 3);
  EXPECT_THAT(missing.error, HasSubstr("f.csv.part"));
  const Outcome replayed = Run("ALPENGLOW_DISPLAY=8x8", replay + "f.csv.part");
  EXPECT_EQ(replayed.status, 0) << replayed.error;
  EXPECT_THAT(replayed.error, HasSubstr("cut short"));
  const Outcome again = Run("ALPENGLOW_DISPLAY=8x8", replay + "f.csv.part --record f.csv");
  EXPECT_EQ(again.status, 3) << "the record would be written over what is replayed";
}

TEST_F(SkyviewWindow, AReplayBeginsAtTheStartOfTheFlight) {
  WriteText(folder_ / "p.csv",
            "t_s,latitude,longitude,height_m,heading,utc\n0,46.5,8,3000,350,2026-06-21T10:00:00Z\n"
            "1000,46.6,8,3100,10,2026-06-21T10:16:40Z\n");
  const Outcome outcome = Run("ALPENGLOW_DISPLAY='16x9 16x9 16x9'",
                              "--replay p.csv --record f.csv --frames 2 --screenshot shot.png");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const CameraPath shown = ReadCameraPath(folder_ / "f.csv");
  EXPECT_NEAR(shown.points().back().pose.place.height_m, 3003.0, 3.0) << "of its first minute";
  const double since_s =
      SecondsBetween(ParseInstant("2026-06-21T10:00:00Z"), *shown.points().back().utc);
  EXPECT_GE(since_s, 0.0);
  EXPECT_LT(since_s, 60.0);
}

TEST_F(SkyviewWindow, AWindowBeyondTheDriversLimitIsRefused) {
  const Outcome outcome = Run("ALPENGLOW_DISPLAY='40000x8 40000x8'", "--record f.csv");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.error, HasSubstr("--size 40000x8"));
  EXPECT_THAT(outcome.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.csv"));
}

TEST_F(SkyviewWindow, ClosingOrLosingTheDisplayWritesThePictureOfF3) {
  const Outcome closed = Run("ALPENGLOW_DISPLAY='64x36 key:292,0 64x36'", "");
  EXPECT_EQ(closed.status, 0) << closed.error;
  const Outcome gone = Run("ALPENGLOW_DISPLAY='64x36 key:292,0 64x36 gone 64x36'", "");
  EXPECT_EQ(gone.status, 5);
  EXPECT_THAT(gone.error, HasSubstr("skyview-0002.png is written"));
  for (const char* name : {"skyview-0001.png", "skyview-0002.png"})
    EXPECT_EQ(ReadPng(folder_ / name).width, 64);
}

TEST_F(SkyviewWindow, ShiftF10TogglesFullScreen) {
  const Outcome outcome = Run("ALPENGLOW_DISPLAY='16x9 key:299,1 16x9 key:299,1 16x9'", "");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("screen 200x100\n"));
  EXPECT_THAT(outcome.out, HasSubstr("window 8x4\n")) << "in units of the desktop, as before";
}

}  // namespace
}  // namespace alpenglow::viewer
