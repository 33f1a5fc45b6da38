// SPDX-License-Identifier: MIT
#include "lut/image/picture_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lut/cli/output_file.h"
#include "lut/image/development.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

class PictureFormatTest : public TemporaryFolder {};

TEST_F(PictureFormatTest, EveryFormatKeepsTheMetadata) {
  const HdrImage image(4, 3);
  const Metadata metadata{{"alpenglow.place", "Zürich"}};
  for (const PictureFormat& format : PictureFormats()) {
    const std::filesystem::path file = folder_ / (std::string("a") + format.extension);
    ASSERT_NE(format.write_light == nullptr, format.write_colours == nullptr) << format.name;
    if (format.StoresLight()) {
      format.write_light(file, image, metadata, Projection::kCamera);
    } else {
      format.write_colours(file, Develop(image, 10.0, {}), metadata);
    }
    EXPECT_THAT(format.read_metadata(file), Contains(Pair("alpenglow.place", "Zürich")))
        << format.name;
  }
}

TEST_F(PictureFormatTest, ExtensionSelectsTheFormat) {
  for (const PictureFormat& format : PictureFormats())
    EXPECT_EQ(&FormatOfPicture(std::string("a.b") + format.extension), &format) << format.name;
  EXPECT_STREQ(FormatOfPicture("A.EXR").name, "EXR");
}

TEST_F(PictureFormatTest, NoFolderIsNamedLikeAPicture) {
  for (const PictureFormat& format : PictureFormats())
    EXPECT_NE(FaultOfFolderName(std::string("a") + format.extension), "") << format.name;
  EXPECT_EQ(FaultOfFolderName("tables.v2"), "");
}

TEST_F(PictureFormatTest, MessagesListEveryFormat) {
  const std::string fault = tests::FaultOf([] { (void)FormatOfPicture("a.jpg"); });
  EXPECT_THAT(fault, HasSubstr("\"a.jpg\" is no picture's name; it must end in .png"));
  for (const PictureFormat& format : PictureFormats()) {
    EXPECT_THAT(fault, HasSubstr(format.extension));
    EXPECT_THAT(NamesOfPictureFormats(), HasSubstr(format.name));
  }
  EXPECT_THAT(NamesOfDevelopedFormats(), AllOf(HasSubstr("PNG"), Not(HasSubstr("EXR"))));
}

}  // namespace
}  // namespace alpenglow::lut
