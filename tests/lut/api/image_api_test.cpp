// SPDX-License-Identifier: MIT
#include <OpenEXR/ImfThreading.h>
#include <alpenglow/errors.h>
#include <alpenglow/image.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>

#include "lut/image/development.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/png.h"
#include "lut/image/white_balance.h"
#include "tests/fixtures/comma_locale.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

HdrImage Gradient() {
  HdrImage image;
  image.width = 8;
  image.height = 4;
  for (int i = 0; i < 32; ++i) {
    const auto light = static_cast<float>(100 * i);
    image.rgb.push_back({light, 0.8F * light, 0.6F * light});
  }
  image.layers = {{"depth.Z", std::vector<float>(32, 7.0F)}};
  image.metadata = {{"alpenglow.utc", "2026-06-21T04:00:00Z"}};
  return image;
}

class ApiImage : public TemporaryFolder {};

TEST_F(ApiImage, SurvivesARoundTripThroughItsFile) {
  HdrImage image = Gradient();
  image.is_panorama = true;
  WriteExr(folder_ / "a.exr", image);
  const HdrImage read = ReadExr(folder_ / "a.exr");
  EXPECT_EQ(read.width, 8);
  EXPECT_EQ(read.height, 4);
  EXPECT_EQ(read.rgb, image.rgb);
  ASSERT_EQ(read.layers.size(), 1U);
  EXPECT_EQ(read.layers[0].name, "depth.Z");
  EXPECT_EQ(read.layers[0].values, image.layers[0].values);
  EXPECT_TRUE(read.is_panorama);
  EXPECT_EQ(read.metadata.at("alpenglow.utc"), "2026-06-21T04:00:00Z");
}

TEST_F(ApiImage, SizesLayersAndMetadataBeyondFilesAreRefused) {
  const auto refuses = [&](const auto& change) {
    HdrImage image = Gradient();
    change(image);
    EXPECT_THROW(WriteExr(folder_ / "a.exr", image), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
  };
  refuses([](HdrImage& image) { image.width = -8; });
  refuses([](HdrImage& image) { image.width = 0; });
  refuses([](HdrImage& image) { image.height = 100000; });
  refuses([](HdrImage& image) { image.width = image.height = 32768; });
  refuses([](HdrImage& image) { image.layers[0].name = ""; });
  refuses([](HdrImage& image) { image.layers[0].name = "R"; });
  refuses([](HdrImage& image) { image.layers[0].name = std::string(300, 'a'); });
  refuses([](HdrImage& image) { image.layers.push_back(image.layers[0]); });
  refuses([](HdrImage& image) { image.metadata[""] = "nothing"; });
  refuses([](HdrImage& image) { image.metadata[std::string(80, 'a')] = "long"; });
  refuses([](HdrImage& image) { image.metadata["dataWindow"] = "of OpenEXR"; });
  refuses([](HdrImage& image) { image.metadata["a\nb"] = "two lines"; });
  HdrImage image = Gradient();
  image.metadata[std::string(80, 'a')] = "long";
  EXPECT_THROW(WritePng(folder_ / "a.png", image), InputError);
}

TEST_F(ApiImage, KeepsTheNumberOfThreadsOfOpenExr) {
  for (const int threads : {0, 1, 3}) {
    Imf::setGlobalThreadCount(threads);
    WriteExr(folder_ / "a.exr", Gradient());
    EXPECT_EQ(Imf::globalThreadCount(), threads);
  }
  Imf::setGlobalThreadCount(0);
}

TEST_F(ApiImage, IsDevelopedAsByTheLayerBelow) {
  const HdrImage image = Gradient();
  HdrImage light(8, 4);
  light.rgb = image.rgb;
  lut::Look look = lut::LookFromName("aces");
  look.white = lut::WhiteBalanceFromText("camera");
  look = lut::Settled(look, light);
  const HdrImage seen = lut::Seen(light, look);
  const std::vector<std::uint8_t> fixed = lut::Develop(seen, 12.0, look).rgb;
  EXPECT_EQ(ForDisplay(image, {.ev100 = 12.0, .tone_map = "aces"}), fixed);
  const double metered =
      lut::Ev100By({}, lut::MeterEv100(seen, lut::kSunDiskLuminance_cd_per_m2), look);
  EXPECT_EQ(ForDisplay(image, {.ev100 = std::nullopt, .tone_map = "aces"}),
            lut::Develop(seen, metered, look).rgb);
  WritePng(folder_ / "a.png", image, {.ev100 = 12.0, .tone_map = "aces"});
  EXPECT_EQ(lut::ReadPng(folder_ / "a.png").rgb, fixed);
}

TEST_F(ApiImage, IsExposedByTheRuleOfTheOptions) {
  const HdrImage image = Gradient();
  EXPECT_EQ(ExposureValue(image, {.ev100 = 12.0}), 12.0);
  EXPECT_EQ(ExposureValue(image, {.exposure = "12"}), 12.0);
  EXPECT_EQ(ExposureValue(image, {.exposure = "incident", .illuminance_lx = 2.5 * 1024.0}), 10.0);
  HdrImage dusk = image;
  for (auto& pixel : dusk.rgb)
    for (float& value : pixel) value *= 1e-3F;
  EXPECT_GT(ExposureValue(dusk, {.exposure = "eye"}), ExposureValue(dusk));
  WritePng(folder_ / "a.png", image, {.exposure = "incident", .illuminance_lx = 2.5 * 1024.0});
  const Metadata header = lut::ReadPngMetadata(folder_ / "a.png");
  EXPECT_EQ(header.at("alpenglow.ev100"), "10.0000");
  EXPECT_EQ(header.at("alpenglow.exposure"), "incident");
  EXPECT_EQ(header.at("alpenglow.utc"), "2026-06-21T04:00:00Z");
}

TEST_F(ApiImage, WrongImagesOptionsAndFilesAreRefused) {
  HdrImage image = Gradient();
  EXPECT_THROW((void)ForDisplay(image, {.exposure = "incident"}), InputError);
  EXPECT_THROW((void)ForDisplay(image, {.exposure = "incident", .illuminance_lx = -1.0}),
               InputError);
  EXPECT_THROW((void)ForDisplay(image, {.exposure = "late"}), InputError);
  EXPECT_THROW((void)ForDisplay(image, {.night_vision = true}), InputError)
      << "the image has no scotopic luminance";
  EXPECT_THROW((void)ForDisplay(image, {.ev100 = 31.0}), InputError);
  EXPECT_THROW((void)ForDisplay(image, {.ev100 = 1.0, .tone_map = "film"}), InputError);
  EXPECT_THROW((void)ReadExr(folder_ / "none.exr"), InputError);
  EXPECT_THROW(WriteExr(folder_ / "none" / "a.exr", image), OutputError);
  image.rgb[3][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(WriteExr(folder_ / "a.exr", image), InputError);
  image.rgb.pop_back();
  EXPECT_THROW((void)ForDisplay(image), InputError);
  image = Gradient();
  image.layers[0].values.pop_back();
  EXPECT_THROW(WriteExr(folder_ / "a.exr", image), InputError);
}

TEST_F(ApiImage, NumbersInFilesDoNotFollowTheLocale) {
  const HdrImage image = Gradient();
  WritePng(folder_ / "plain.png", image);
  WriteExr(folder_ / "plain.exr", image);
  const tests::CommaLocale locale(folder_);
  WritePng(folder_ / "comma.png", image);
  WriteExr(folder_ / "comma.exr", image);
  EXPECT_EQ(ContentOf(folder_ / "comma.png"), ContentOf(folder_ / "plain.png"));
  EXPECT_EQ(ContentOf(folder_ / "comma.exr"), ContentOf(folder_ / "plain.exr"));
  const std::string ev100 = lut::ReadPngMetadata(folder_ / "comma.png").at("alpenglow.ev100");
  EXPECT_EQ(ev100.find(','), std::string::npos) << ev100;
  EXPECT_NE(ev100.find('.'), std::string::npos) << ev100;
}

}  // namespace
}  // namespace alpenglow
