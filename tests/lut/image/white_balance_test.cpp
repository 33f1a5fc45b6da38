// SPDX-License-Identifier: MIT
#include "lut/image/metering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "lut/image/look.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

WhiteBalance OfKelvin(double kelvin) { return {WhiteBalance::Kind::kKelvin, kelvin}; }

std::array<double, 2> ChromaticityOf(double kelvin) {
  const auto [x, y, z] = WhiteOfTemperature(kelvin);
  return {x / (x + y + z), y / (x + y + z)};
}

Image Uniform(const std::array<double, 3>& rgb, double luminance) {
  Image image(20, 20);
  for (auto& pixel : image.rgb) {
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(luminance * rgb[c]);
  }
  return image;
}

TEST(WhiteBalance, LightsHaveThePublishedChromaticities) {
  // CIE 15: A is Planck's at 2856 K, D50 and D65 are daylight of 5003 and 6504 K.
  const struct {
    double kelvin, x, y;
  } rows[] = {{2856.0, 0.44758, 0.40745}, {5003.0, 0.34567, 0.35850}, {6504.0, 0.31272, 0.32903}};
  for (const auto& row : rows) {
    const auto [x, y] = ChromaticityOf(row.kelvin);
    EXPECT_NEAR(x, row.x, 2e-4) << row.kelvin << " K, sums of 5 nm against 1 nm";
    EXPECT_NEAR(y, row.y, 2e-4) << row.kelvin << " K";
  }
}

TEST(WhiteBalance, LightsChangeWithTemperatureWithoutAJump) {
  auto before = ChromaticityOf(kWarmestWhite_k);
  for (double mired = 1e6 / kWarmestWhite_k; mired > 1e6 / kCoolestWhite_k; mired -= 1.0) {
    const auto now = ChromaticityOf(1e6 / mired);
    EXPECT_LT(std::hypot(now[0] - before[0], now[1] - before[1]), 3e-3) << 1e6 / mired;
    before = now;
  }
}

TEST(WhiteBalance, TheTemperatureOfALightIsFoundAgain) {
  for (const double kelvin : {1600.0, 2856.0, 4400.0, 5600.0, 6504.0, 9000.0, 20000.0}) {
    EXPECT_NEAR(1e6 / TemperatureOf(WhiteOfTemperature(kelvin)), 1e6 / kelvin, 0.1)
        << "to a tenth of a mired";
  }
}

TEST(WhiteBalance, PaperUnderTheLightThatIsAskedForIsWhiteAndAsBright) {
  for (const double kelvin : {2000.0, 3000.0, 4500.0, 5600.0, 12000.0}) {
    const Image paper = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(kelvin), 100.0);
    const auto rgb = Balanced(paper, OfKelvin(kelvin)).at(0, 0);
    for (const float channel : rgb) EXPECT_NEAR(channel, 100.0F, 2e-3F) << kelvin << " K";
  }
}

TEST(WhiteBalance, DaylightLeavesPicturesAloneAndAWarmerLightMakesThemBluer) {
  const Image grey = Uniform({1.0, 1.0, 1.0}, 100.0);
  EXPECT_EQ(Balanced(grey, {}).rgb, grey.rgb);
  EXPECT_EQ(Balanced(grey, OfKelvin(kDaylight_k)).rgb, grey.rgb);
  const auto near = Balanced(grey, OfKelvin(6503.9)).at(0, 0);
  for (const float channel : near)
    EXPECT_NEAR(channel, 100.0F, 0.1F) << "D65 of sRGB is given to four digits";
  const auto flash = Balanced(grey, OfKelvin(5600.0)).at(0, 0);
  const auto lamp = Balanced(grey, OfKelvin(3000.0)).at(0, 0);
  EXPECT_GT(flash[2] / flash[0], 1.05F);
  EXPECT_GT(lamp[2] / lamp[0], 2.0F * flash[2] / flash[0]);
}

TEST(WhiteBalance, AutoTakesTheMeteredLightForWhiteAsFarAsACameraDoes) {
  const auto settled = [](double kelvin) {
    const Image image = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(kelvin), 500.0);
    return *Settled({WhiteBalance::Kind::kAuto}, image, Projection::kCamera).kelvin;
  };
  EXPECT_NEAR(settled(4000.0), 4000.0, 5.0) << "a tenth of a mired, and colours are floats";
  EXPECT_NEAR(settled(5600.0), 5600.0, 5.0);
  EXPECT_EQ(settled(2200.0), 3000.0) << "candles stay warm";
  EXPECT_EQ(settled(15000.0), 7000.0) << "a blue sky stays blue";
  EXPECT_NEAR(*Settled({WhiteBalance::Kind::kAuto}, Image(4, 4), Projection::kCamera).kelvin,
              6504.0, 40.0)
      << "no light: D65 of sRGB is off the locus in its fourth digit";
}

TEST(WhiteBalance, AutoDoesNotLookAtTheSunNorAtLamps) {
  Image image = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(5600.0), 500.0);
  const WhiteBalance ask{WhiteBalance::Kind::kAuto};
  const double without = *Settled(ask, image, Projection::kCamera).kelvin;
  for (int x = 0; x < 10; ++x) image.at(x, 0) = {9e4F, 3e4F, 2e3F};    // 2.5 % of sodium lamps
  for (int x = 0; x < 20; ++x) image.at(x, 1) = {2e9F, 1e9F, 0.3e9F};  // the sun
  EXPECT_NEAR(*Settled(ask, image, Projection::kCamera).kelvin, without, 1.0);
}

TEST(WhiteBalance, ACameraIsSetToDaylightByDayAnd4000KelvinByNight) {
  EXPECT_EQ(CameraWhite(15.0), kDaylight_k);
  EXPECT_EQ(CameraWhite(4.0), kDaylight_k) << "the end of civil twilight";
  EXPECT_DOUBLE_EQ(CameraWhite(-2.0), 4000.0) << "a full moon";
  EXPECT_DOUBLE_EQ(CameraWhite(-9.0), 4000.0);
  double before = CameraWhite(6.0);
  for (double ev100 = 6.0; ev100 > -4.0; ev100 -= 0.3) {
    const double now = CameraWhite(ev100);
    EXPECT_LE(now, before);
    EXPECT_LT(1e6 / now - 1e6 / before, 10.0)
        << "mireds in a minute of dusk, at " << ev100 << ": the least that filters are sold for";
    before = now;
  }
  const WhiteBalance ask{WhiteBalance::Kind::kCamera};
  const auto settled = [&](double luminance) {
    return Settled(ask, Uniform({1.0, 1.0, 1.0}, luminance), Projection::kCamera);
  };
  EXPECT_TRUE(settled(500.0).IsDaylight());
  EXPECT_NEAR(*settled(1e-3).kelvin, 4000.0, 1e-9);
}

TEST(WhiteBalance, IsCameraDaylightAutoOrKelvin) {
  EXPECT_EQ(WhiteBalanceFromText("camera").kind, WhiteBalance::Kind::kCamera);
  EXPECT_EQ(WhiteBalanceFromText("daylight"), WhiteBalance{});
  EXPECT_EQ(WhiteBalanceFromText("auto").kind, WhiteBalance::Kind::kAuto);
  EXPECT_EQ(WhiteBalanceFromText("5600"), OfKelvin(5600.0));
  EXPECT_EQ(WhiteBalanceFromText("3200K"), OfKelvin(3200.0));
  for (const char* bad : {"", "warm", "1000", "26000", "5600 K", "5600Kelvin", "nan"})
    EXPECT_THROW((void)WhiteBalanceFromText(bad), InputError) << bad;
  EXPECT_EQ(NameOf(OfKelvin(5600.0)), "5600 K, CAT16");
  EXPECT_EQ(NameOf(WhiteBalance{WhiteBalance::Kind::kAuto, 4312.4}), "auto, 4312 K, CAT16");
  EXPECT_EQ(NameOf(WhiteBalance{WhiteBalance::Kind::kCamera, 4000.0}), "camera, 4000 K, CAT16");
}

TEST(WhiteBalance, IsPartOfWhatIsSeen) {
  const Image lit = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(3000.0), 50.0);
  Look look;
  look.white = {WhiteBalance::Kind::kAuto};
  EXPECT_THROW((void)Seen(lit, look), InternalError) << "auto asks for a picture first";
  const auto rgb = Seen(lit, Settled(look, lit)).at(0, 0);
  EXPECT_NEAR(rgb[0], rgb[2], 0.05F);
}

}  // namespace
}  // namespace alpenglow::lut
