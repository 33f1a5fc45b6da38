// SPDX-License-Identifier: MIT
#include "renderer/ground/scene_ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Latitudes 46 to 47, longitudes 8 to 9, everything 500 m high.
class AModel : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    const std::string high("\x01\xf4");  // big endian
    std::ofstream file(File(), std::ios::binary);
    for (int sample = 0; sample < 1201 * 1201; ++sample) file << high;
  }

  [[nodiscard]] std::filesystem::path File() const { return folder_ / "N46E008.hgt"; }
  [[nodiscard]] Scene At(double latitude, double longitude) const {
    SceneOptions options;
    options.dem = File().string();
    options.latitude = latitude;
    options.longitude = longitude;
    return SceneFromOptions(options);
  }
  [[nodiscard]] static std::string FaultOf(const Scene& scene) {
    try {
      static_cast<void>(LoadGround(scene));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

TEST_F(AModel, RefusesAnEyeThatStandsOutsideAndNamesItsPlaceAndTheModels) {
  const std::string fault = FaultOf(At(45.5, 8.5));
  EXPECT_THAT(fault, HasSubstr("latitude 45.5, longitude 8.5"));
  EXPECT_THAT(fault, HasSubstr("N46E008.hgt"));
  EXPECT_THAT(fault, HasSubstr("latitudes 46 to 47 and longitudes 8 to 9"));
  EXPECT_THAT(fault, Not(HasSubstr("swapped")));
  EXPECT_THAT(FaultOf(At(47.0000001, 8.5)), HasSubstr("latitude 47.0000001, "))
      << "as many digits as tell it from 47";
  EXPECT_THAT(FaultOf(At(8.5, 46.5)), HasSubstr("latitude and longitude seem to be swapped"));
}

TEST_F(AModel, IsSeenFromOutsideByAnEyeHighEnough) {
  // From 1 km one sees 113 km far, and the model's 500 m stick out from 80 km farther.
  Scene scene = At(45.0, 8.5);
  scene.camera.height = {1000.0, false};
  EXPECT_EQ(FaultOf(scene), "") << "111 km away";
  scene = At(44.0, 8.5);
  scene.camera.height = {1000.0, false};
  EXPECT_THAT(FaultOf(scene), HasSubstr("is outside")) << "222 km away";
  scene.camera.height = {4e5, false};
  EXPECT_EQ(FaultOf(scene), "") << "from space";
}

TEST_F(AModel, IsWhatAnEyeInsideStandsOnWithoutAWord) {
  const SceneGround ground = LoadGround(At(46.5, 8.5));
  EXPECT_NEAR(ground.eye_height_m, 502.0, 0.1) << "a facet sags by less";
  EXPECT_EQ(ground.message, "");
}

TEST(SceneGround, TellsThatTerrainIsMadeUp) {
  SceneOptions options;
  options.latitude = 47.0;
  options.longitude = 11.0;
  EXPECT_THAT(LoadGround(SceneFromOptions(options)).message, HasSubstr("made up"));
}

}  // namespace
}  // namespace alpenglow
