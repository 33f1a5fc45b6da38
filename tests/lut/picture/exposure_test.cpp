// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "lut/picture/image.h"

namespace alpenglow {
namespace {

constexpr double kSunDisk_cd_per_m2 = 1.6e9;
constexpr double kNotTheDisk_cd_per_m2 = 1e8;

Image Uniform(float luminance) {
  Image image(40, 40);
  for (auto& pixel : image.rgb) pixel = {luminance, luminance, luminance};
  return image;
}

TEST(Exposure, Sunny16) {
  // f/16 at 1/100 s, ISO 100: EV 14.6; a grey card in full sun has 4096 cd/m^2 at EV 15.
  EXPECT_NEAR(MeterEv100(Uniform(4096.0F), kNotTheDisk_cd_per_m2), 15.0, 0.04)
      << "log2(4096 * 100 / 12.5) = 15; the histogram has 16 bins a stop";
}

TEST(Exposure, SaturationIs1Point2TimesTwoToTheEv) {
  EXPECT_DOUBLE_EQ(ExposureScale(0.0) * 1.2, 1.0);
  EXPECT_DOUBLE_EQ(ExposureScale(15.0) * 1.2 * 32768.0, 1.0);
}

TEST(Exposure, OneStopMoreLightIsOneEv) {
  const double once = MeterEv100(Uniform(100.0F), kNotTheDisk_cd_per_m2);
  const double twice = MeterEv100(Uniform(200.0F), kNotTheDisk_cd_per_m2);
  EXPECT_NEAR(twice - once, 1.0, 1e-12) << "a stop is 16 bins exactly";
}

TEST(Exposure, TheSunsDiskDoesNotCount) {
  Image image = Uniform(1000.0F);
  const double without = MeterEv100(image, kNotTheDisk_cd_per_m2);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) image.at(x, y).fill(static_cast<float>(kSunDisk_cd_per_m2));
  }
  EXPECT_DOUBLE_EQ(MeterEv100(image, kNotTheDisk_cd_per_m2), without);
}

TEST(Exposure, DarkestAndBrightestPixelsHaveNoWeight) {
  Image image = Uniform(1000.0F);
  const double uniform = MeterEv100(image, kNotTheDisk_cd_per_m2);
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 12; ++y) image.at(x, y).fill(0.01F);  // 30 % in deep shadow
    image.at(x, 39).fill(1e6F);                               // 2.5 % of glare
  }
  EXPECT_DOUBLE_EQ(MeterEv100(image, kNotTheDisk_cd_per_m2), uniform);
}

TEST(Exposure, BlackSpaceDoesNotCount) {
  Image image = Uniform(1000.0F);
  const double uniform = MeterEv100(image, kNotTheDisk_cd_per_m2);
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 36; ++y) image.at(x, y).fill(0.0F);
  }
  EXPECT_DOUBLE_EQ(MeterEv100(image, kNotTheDisk_cd_per_m2), uniform);
}

TEST(Exposure, TheMeterHasLimits) {
  EXPECT_EQ(MeterEv100(Uniform(0.0F), kNotTheDisk_cd_per_m2), kDarkestEv100);
  EXPECT_EQ(MeterEv100(Uniform(-1.0F), kNotTheDisk_cd_per_m2), kDarkestEv100);
  EXPECT_EQ(MeterEv100(Uniform(1e-7F), kNotTheDisk_cd_per_m2), kDarkestEv100);
  EXPECT_EQ(MeterEv100(Uniform(5e7F), kNotTheDisk_cd_per_m2), kBrightestEv100);
}

}  // namespace
}  // namespace alpenglow
