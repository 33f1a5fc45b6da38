// SPDX-License-Identifier: MIT
#include "renderer/series/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "atmosphere/base/error.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Videos : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    path_ = std::getenv("PATH");
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    TemporaryFolder::TearDown();
  }
  /// The first ffmpeg on the PATH from here on: a script of the shell.
  void UseFfmpeg(const std::string& script) {
    fs::create_directory(folder_ / "bin");
    WriteText(folder_ / "bin" / "ffmpeg", "#!/bin/sh\n" + script + "\n");
    fs::permissions(folder_ / "bin" / "ffmpeg", fs::perms::owner_all);
    setenv("PATH", ((folder_ / "bin").string() + ":" + path_).c_str(), 1);
  }
  /// What a film of so many frames ends with.
  [[nodiscard]] std::string FaultOfVideo(
      int frames, const std::function<DisplayImage(int)>& frame = Frame) const {
    try {
      WriteVideo(File(), {64, 64, 25.0, {}}, frames, frame);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no fault";
  }
  [[nodiscard]] fs::path File() const { return folder_ / "film.mp4"; }

  /// Red that fades from frame to frame, over green that does not.
  static DisplayImage Frame(int number) {
    DisplayImage image{64, 64, {}};
    for (int pixel = 0; pixel < 64 * 64; ++pixel) {
      const bool upper = pixel < 32 * 64;
      image.rgb.push_back(static_cast<std::uint8_t>(upper ? 200 - 10 * number : 0));
      image.rgb.push_back(static_cast<std::uint8_t>(upper ? 0 : 150));
      image.rgb.push_back(0);
    }
    return image;
  }

 private:
  std::string path_;
};

TEST_F(Videos, AFilmHasThePicturesInTheirOrderAndColours) {
  if (RunCommand("ffmpeg -version").status != 0) GTEST_SKIP() << "there is no ffmpeg here";
  const int frames = 10;
  WriteVideo(File(), {64, 64, 25.0, {{"alpenglow.scene", "a test"}}}, frames, Frame);
  EXPECT_EQ(FileCount(), 1U) << "the film and nothing else";
  ASSERT_EQ(RunCommand("ffmpeg -i film.mp4 -f rawvideo -pix_fmt rgb24 film.raw").status, 0);
  const std::string raw = ContentOf(folder_ / "film.raw");
  const std::size_t bytes = std::size_t{3} * 64 * 64;
  ASSERT_EQ(raw.size(), bytes * frames);
  for (int number = 0; number < frames; ++number) {
    const auto at = [&](std::size_t row, std::size_t channel) {
      const std::size_t pixel = row * 64 + 30;
      return static_cast<int>(static_cast<unsigned char>(
          raw[static_cast<std::size_t>(number) * bytes + 3 * pixel + channel]));
    };
    EXPECT_NEAR(at(10, 0), 200 - 10 * number, 6) << "eight bits of luma, compressed";
    EXPECT_NEAR(at(10, 1), 0, 6);
    EXPECT_NEAR(at(50, 1), 150, 6) << "the lower half stays green";
  }
  EXPECT_THAT(RunCommand("ffmpeg -i film.mp4").error, HasSubstr("alpenglow.scene=a test"));
}

TEST_F(Videos, OddSidesGetALine) {
  if (RunCommand("ffmpeg -version").status != 0) GTEST_SKIP() << "there is no ffmpeg here";
  const auto frame = [](int) {
    return DisplayImage{63, 35, std::vector<std::uint8_t>(std::size_t{3} * 63 * 35, 99)};
  };
  WriteVideo(folder_ / "odd.mkv", {63, 35, 25.0, {}}, 3, frame);
  EXPECT_THAT(RunCommand("ffmpeg -i odd.mkv").error, HasSubstr("64x36"));
}

TEST_F(Videos, WithoutFfmpegItIsNamedBeforeAnythingIsDrawn) {
  setenv("PATH", folder_.c_str(), 1);
  EXPECT_THROW(RequireVideo(File()), OutputError);
  const auto frame = [](int) -> DisplayImage { throw InputError("a frame was drawn"); };
  EXPECT_THAT(FaultOfVideo(1, frame), HasSubstr("needs ffmpeg"));
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(Videos, WhatFfmpegSaysIsSaidAndNoFileIsLeft) {
  UseFfmpeg("echo a first line >&2; echo Unknown encoder >&2; exit 1");
  EXPECT_THAT(FaultOfVideo(100), HasSubstr("ffmpeg: Unknown encoder"));
  UseFfmpeg("while read -r line; do :; done; exit 7");
  EXPECT_THAT(FaultOfVideo(3), HasSubstr("gives no reason"));
  UseFfmpeg("kill -9 $$");
  EXPECT_THAT(FaultOfVideo(100), HasSubstr("film.mp4")) << "the file that is missing is named";
  EXPECT_EQ(FileCount(), 1U) << "the folder of the script";
}

TEST_F(Videos, AFrameThatFailsLeavesNoFileAndNoProcess) {
  UseFfmpeg("echo $$ > " + (folder_ / "process").string() + "; exec sleep 1000");
  const auto frame = [&](int number) {
    if (number == 1) throw InputError("the second picture");
    while (ContentOf(folder_ / "process").empty()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return Frame(number);
  };
  EXPECT_EQ(FaultOfVideo(3, frame), "the second picture");
  EXPECT_NE(kill(std::stoi(ContentOf(folder_ / "process")), 0), 0) << "it has been ended";
  EXPECT_FALSE(fs::exists(File()));
}

TEST_F(Videos, OtherNamesAreRefused) {
  EXPECT_THROW(RequireVideo("film.gif"), InputError);
  EXPECT_THROW(RequireVideo("film"), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
