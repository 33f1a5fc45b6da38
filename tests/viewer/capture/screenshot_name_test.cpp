// SPDX-License-Identifier: MIT
#include "viewer/capture/screenshot_name.h"

#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

class ScreenshotNames : public TemporaryFolder {};

TEST_F(ScreenshotNames, ANumberIsFreeWhenNeitherPictureHasIt) {
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0001");
  WriteText(folder_ / "skyview-0001.exr", "");
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0002");
  WriteText(folder_ / "skyview-0002.png", "");
  WriteText(folder_ / "skyview-0004.png", "");
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0003");
}

}  // namespace
}  // namespace alpenglow
