// SPDX-License-Identifier: MIT
#include "lut/image/local_exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

float LuminanceAt(const Image& image, int x, int y) {
  const auto& rgb = image.at(x, y);
  return shared::Luminance<float>(rgb[0], rgb[1], rgb[2]);
}

// A bright sky over a dark valley, ten stops apart, both with fine ripples of a tenth.
constexpr int kSide = 128;
Image SkyOverValley() {
  Image image(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float ripple = (x + y) % 2 == 0 ? 1.1F : 1.0F;
      const float level = y < kSide / 2 ? 8192.0F : 8.0F;
      image.at(x, y) = {1.2F * ripple * level, ripple * level, 0.8F * ripple * level};
    }
  }
  return image;
}

TEST(LocalExposure, BringsBrightAndDarkPartsTogether) {
  const Image picture = SkyOverValley();
  const Image exposed = LocallyExposed(picture, 11.0);
  const float before = std::log2(LuminanceAt(picture, 64, 20) / LuminanceAt(picture, 64, 108));
  const float after = std::log2(LuminanceAt(exposed, 64, 20) / LuminanceAt(exposed, 64, 108));
  EXPECT_NEAR(before, 10.0F, 1e-3F);
  EXPECT_NEAR(after, 5.0F, 0.1F) << "the range asked for";
}

TEST(LocalExposure, KeepsTheContrastOfDetail) {
  const Image exposed = LocallyExposed(SkyOverValley(), 11.0);
  for (const int y : {20, 108}) {
    const float contrast = LuminanceAt(exposed, 64, y) / LuminanceAt(exposed, 65, y);
    EXPECT_NEAR(contrast, 1.1F, 0.02F) << "ripples of a tenth stay ripples of a tenth";
  }
}

TEST(LocalExposure, DrawsNoHaloAlongAnEdge) {
  const Image exposed = LocallyExposed(SkyOverValley(), 11.0);
  for (int y = 0; y < kSide; ++y) {
    const int far = y < kSide / 2 ? 10 : kSide - 11;
    const int x = (y + far) % 2 == 0 ? 64 : 65;  // the same phase of the ripple
    EXPECT_NEAR(LuminanceAt(exposed, x, y) / LuminanceAt(exposed, 64, far), 1.0F, 0.08F)
        << "row " << y << ": a tenth is where halos begin to be seen";
  }
}

TEST(LocalExposure, KeepsHueAndLeavesSmallRangesAlone) {
  const Image exposed = LocallyExposed(SkyOverValley(), 11.0);
  const auto& rgb = exposed.at(30, 90);
  EXPECT_NEAR(rgb[0] / rgb[1], 1.2F, 1e-5F);
  EXPECT_NEAR(rgb[2] / rgb[1], 0.8F, 1e-5F);
  Image flat(16, 16);
  for (int i = 0; i < 256; ++i)
    flat.rgb[static_cast<std::size_t>(i)] = {1.0F + 0.01F * static_cast<float>(i), 1.0F, 1.0F};
  EXPECT_EQ(LocallyExposed(flat, 3.0).rgb, flat.rgb) << "already within five stops";
}

TEST(LocalExposure, MiddleGreyStaysWhereTheExposureHasIt) {
  Image image(kSide, kSide);
  const auto grey = static_cast<float>(std::exp2(9.0) * kMeterConstant / 100.0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float level = y < 43 ? grey * 64.0F : y < 86 ? grey : grey / 64.0F;
      image.at(x, y) = {level, level, level};
    }
  }
  EXPECT_NEAR(LuminanceAt(LocallyExposed(image, 9.0), 64, 64) / grey, 1.0F, 0.02F);
}

TEST(LocalExposure, DarknessStaysDarkAndFinite) {
  Image image(32, 32);
  EXPECT_EQ(LocallyExposed(image, 0.0).rgb, image.rgb);
  image.at(3, 3) = {1e5F, 1e5F, 1e5F};
  image.at(4, 4) = {-1.0F, -1.0F, -1.0F};
  for (const auto& rgb : LocallyExposed(image, 0.0).rgb) {
    for (const float channel : rgb) EXPECT_TRUE(std::isfinite(channel));
  }
}

}  // namespace
}  // namespace alpenglow::lut
