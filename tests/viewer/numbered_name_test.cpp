// SPDX-License-Identifier: MIT
#include "viewer/picture_writer.h"

#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::viewer {
namespace {

class NumberedNames : public TemporaryFolder {};

TEST_F(NumberedNames, ANumberIsFreeWhenNeitherPictureHasIt) {
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0001");
  WriteText(folder_ / "skyview-0001.exr", "");
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0002");
  WriteText(folder_ / "skyview-0002.png", "");
  WriteText(folder_ / "skyview-0004.png", "");
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0003");
}

TEST_F(NumberedNames, AFlightThatIsBeingRecordedHasItsNumber) {
  EXPECT_EQ(NextFlight(folder_), folder_ / "flight-0001.csv");
  WriteText(folder_ / "flight-0001.csv.part", "");
  EXPECT_EQ(NextFlight(folder_), folder_ / "flight-0002.csv");
  WriteText(folder_ / "flight-0002.csv", "");
  EXPECT_EQ(NextFlight(folder_), folder_ / "flight-0003.csv");
}

}  // namespace
}  // namespace alpenglow::viewer
