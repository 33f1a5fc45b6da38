// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lut/image/image.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"
#include "tests/fixtures/flat_picture.h"

namespace alpenglow::lut {
namespace {

constexpr double kSunDisk_cd_per_m2 = 1.6e9;
constexpr double kNotTheDisk_cd_per_m2 = 1e8;

HdrImage Uniform(float luminance) { return tests::FlatPicture(40, 40, luminance); }

double Metered(const HdrImage& image) { return MeterEv100(image, kNotTheDisk_cd_per_m2); }

/// Fills rows from `begin` to before `end`.
void FillRows(HdrImage& image, int begin, int end, float luminance) {
  for (int y = begin; y < end; ++y) {
    for (int x = 0; x < image.width; ++x) image.at(x, y).fill(luminance);
  }
}

TEST(Exposure, AgreesWithTheSunny16Rule) {
  // f/16 at 1/100 s, ISO 100: EV 14.6; a grey card in full sun has 4096 cd/m^2 at EV 15.
  EXPECT_NEAR(Metered(Uniform(4096.0F)), 15.0, 0.04)
      << "log2(4096 * 100 / 12.5) = 15; the histogram has 16 bins a stop";
  EXPECT_NEAR(Metered(Uniform(200.0F)) - Metered(Uniform(100.0F)), 1.0, 1e-12)
      << "a stop is 16 bins exactly";
  for (const float dark : {0.0F, -1.0F, 1e-7F})
    EXPECT_EQ(Metered(Uniform(dark)), kDarkestEv100) << "the meter has limits";
  EXPECT_EQ(Metered(Uniform(5e7F)), kBrightestEv100);
}

TEST(Exposure, SaturationIs1Point2TimesTwoToTheEv) {
  EXPECT_DOUBLE_EQ(ExposureScale(0.0) * 1.2, 1.0);
  EXPECT_DOUBLE_EQ(ExposureScale(15.0) * 1.2 * 32768.0, 1.0);
}

TEST(Exposure, IgnoresTheDiskOfTheSun) {
  HdrImage image = Uniform(1000.0F);
  const double without = Metered(image);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) image.at(x, y).fill(static_cast<float>(kSunDisk_cd_per_m2));
  }
  EXPECT_DOUBLE_EQ(Metered(image), without);
  FillRows(image, 10, 36, 0.0F);
  EXPECT_DOUBLE_EQ(Metered(image), without) << "black space does not count either";
}

TEST(Exposure, DarkestAndBrightestPixelsHaveNoWeight) {
  HdrImage image = Uniform(1000.0F);
  const double uniform = Metered(image);
  FillRows(image, 0, 12, 0.01F);  // 30 % in deep shadow
  FillRows(image, 39, 40, 1e6F);  // 2.5 % of glare
  EXPECT_DOUBLE_EQ(Metered(image), uniform);
}

// The lower rows of a picture are lit ground, the others have a luminance of their own.
HdrImage GroundUnder(float sky_cd_per_m2, int rows_of_ground) {
  HdrImage image = Uniform(6000.0F);
  FillRows(image, 0, 40 - rows_of_ground, sky_cd_per_m2);
  return image;
}

TEST(Exposure, IgnoresSpaceAboveThinAir) {
  // From 100 km up the sky at noon has 0.003 to 0.1 cd/m^2, the ground 6000.
  const double ground = Metered(Uniform(6000.0F));
  for (const float sky : {0.003F, 0.1F}) {
    EXPECT_DOUBLE_EQ(Metered(GroundUnder(sky, 12)), ground) << sky;
  }
}

TEST(Exposure, MetersSunlitGroundBelowABlackSkyAtAllHeights) {
  // From 25 km up the sky at noon is 6 stops darker than the ground, from 40 km 8. Between shares
  // of 40 and 95 % 15 of 55 are sky until it counts less.
  const double ground = Metered(Uniform(6000.0F));
  for (double stops = 5.0; stops < 14.0; stops += 0.5) {
    const auto sky = static_cast<float>(6000.0 * std::exp2(-stops));
    EXPECT_GT(Metered(GroundUnder(sky, 18)), ground - 1.8) << stops;
  }
  const float from_40_km = 6000.0F / 512.0F;
  EXPECT_NEAR(Metered(GroundUnder(from_40_km, 20)), ground, 0.5);
}

TEST(Exposure, IncludesShadedGround) {
  const double even = Metered(Uniform(6000.0F));
  // 70 % of the picture 3 stops darker: between shares of 40 and 95 % that is 30 of 55.
  const double shaded = Metered(GroundUnder(6000.0F / 8.0F, 12));
  EXPECT_NEAR(shaded, even + std::log2((25.0 + 30.0 / 8.0) / 55.0), 1.0 / 16.0)
      << "bins of a 16th of a stop";
}

TEST(Exposure, LandDarkeningFasterThanTheSkyDoesNotRaiseIt) {
  // The sun falls from -14.5 to -18 degrees: half of the picture loses 2 stops, the sky a third.
  const auto sky_shown = [](float sky, float land) {
    HdrImage image = Uniform(sky);
    FillRows(image, 0, 20, land);
    return std::log2(double{sky}) - Metered(image);
  };
  const double before = sky_shown(9e-4F, 9e-5F), after = sky_shown(7e-4F, 2.2e-5F);
  EXPECT_LT(after - before, 0.12) << "land is a tenth of what is weighed, and a tenth as bright";
}

TEST(Exposure, SunlitGroundIsAtMostAsBrightAsPaper) {
  const double even = Metered(Uniform(6000.0F));
  // A tenth of the picture in the sun, the rest 5 stops darker: the mean alone would be 4.5 lower.
  EXPECT_NEAR(Metered(GroundUnder(6000.0F / 32.0F, 4)), even - std::log2(0.90 / 0.18), 1.0 / 16.0);
}

TEST(Exposure, IgnoresLamps) {
  for (const float dusk : {300.0F, 3.0F, 0.03F}) {
    const double without = Metered(Uniform(dusk));
    HdrImage lamps = Uniform(dusk);
    for (int x = 0; x < 40; ++x) lamps.at(x, 20).fill(x % 2 == 0 ? 2e5F : 50.0F * dusk);
    EXPECT_NEAR(Metered(lamps), without, 1.0 / 16.0)
        << dusk << " cd/m^2: 40 of 1600 pixels are lamps and what they light";
  }
}

TEST(Exposure, IsContinuousWhileTheSkyTurnsBlack) {
  double before = Metered(GroundUnder(100.0F, 18));
  for (double stops = 0.0; stops < 14.0; stops += 0.0625) {
    const auto sky = static_cast<float>(100.0 * std::exp2(-stops));
    const double now = Metered(GroundUnder(sky, 18));
    EXPECT_NEAR(now, before, 0.2)
        << "the sky fades by a 16th of a stop from picture to picture; a cut would be 4 stops";
    before = now;
  }
}

// All pixels of a row of sky are as bright: they enter a class of the meter together.
TEST(Exposure, FollowsFadingLightEvenly) {
  constexpr double kStep_ev = 0.13;  // of a minute of dusk
  HdrImage dusk(48, 27);
  for (int y = 0; y < dusk.height; ++y)
    FillRows(dusk, y, y + 1, static_cast<float>(std::exp2(-0.35 * y)));
  double before = MeterEv100(dusk, kSunDiskLuminance_cd_per_m2);
  for (int minute = 1; minute <= 20; ++minute) {
    for (auto& rgb : dusk.rgb)
      for (float& channel : rgb) channel *= static_cast<float>(std::exp2(-kStep_ev));
    const double now = MeterEv100(dusk, kSunDiskLuminance_cd_per_m2);
    EXPECT_NEAR(before - now, kStep_ev, 0.01) << "0.7 % of light: two classes of 1/256 EV";
    before = now;
  }
}

TEST(Exposure, WeighsRowsOfAPanoramaBySolidAngle) {
  // Beyond 30 degrees of latitude lies half of the sphere, on two thirds of the rows.
  HdrImage panorama(8, 96), half(8, 96);
  FillRows(panorama, 0, 96, 100.0F);
  FillRows(panorama, 32, 64, 1000.0F);
  FillRows(half, 0, 48, 100.0F);
  FillRows(half, 48, 96, 1000.0F);
  EXPECT_NEAR(MeterEv100(panorama, kNotTheDisk_cd_per_m2, Projection::kLatitudeLongitude),
              Metered(half), 1e-3)
      << "rows of 2 degrees are taken at their middles";
  EXPECT_LT(Metered(panorama), Metered(half) - 0.5)
      << "as a picture of a camera two thirds are dark";
}

TEST(Exposure, FollowsTheLightFromNightToDay) {
  // A tenth is 8 stops brighter than the rest.
  double before = 0.0;
  for (double stop = -6.0; stop < 16.0; stop += 1.0 / 16.0) {
    const auto bright = static_cast<float>(1.001 * std::exp2(stop));
    HdrImage image = Uniform(bright / 256.0F);
    FillRows(image, 36, 40, bright);
    const double now = Metered(image);
    if (stop > -6.0) {
      EXPECT_NEAR(now, before + 1.0 / 16.0, 1e-3) << "a bin of the histogram at " << stop;
    }
    before = now;
  }
}

TEST(Exposure, RuleIsDescribedInWords) {
  EXPECT_NE(MeterRule().find("0.4 to 0.95 of the solid angle"), std::string::npos) << MeterRule();
  EXPECT_NE(MeterRule().find("over 1e+06 cd/m^2"), std::string::npos) << MeterRule();
}

// Returns light some stops over what EV 12 prints as grey.
std::array<float, 3> At(double stops) {
  const auto y = static_cast<float>(0.125 * std::exp2(12.0 + stops));
  return {y, y, y};
}

float RolledOff(double stops) {
  HdrImage image(1, 1);
  image.rgb = {At(stops)};
  return WithHighlightsRolledOff(image, 12.0).rgb[0][1];
}

TEST(Highlights, AreTheLogarithmOfStopsOverGreyAndKeepTheirColour) {
  for (const double stops : {0.01, 1.0, 3.0, 6.0, 20.0})
    EXPECT_NEAR(RolledOff(stops) / At(std::log1p(stops))[1], 1.0, 2e-6) << stops << " stops, float";
  for (const double stops : {-10.0, -1.0, 0.0}) EXPECT_EQ(RolledOff(stops), At(stops)[1]);
  HdrImage image(1, 1);
  image.rgb = {{4000.0F, 8000.0F, 16000.0F}};
  const std::array<float, 3> rgb = WithHighlightsRolledOff(image, 12.0).rgb[0];
  EXPECT_FLOAT_EQ(rgb[1] / rgb[0], 2.0F);
  EXPECT_FLOAT_EQ(rgb[2] / rgb[1], 2.0F);
}

float LuminanceAt(const HdrImage& image, int x, int y) {
  const auto& rgb = image.at(x, y);
  return shared::Luminance<float>(rgb[0], rgb[1], rgb[2]);
}

// A bright sky over a dark valley, ten stops apart, both with fine ripples of a tenth.
constexpr int kSide = 128;
HdrImage SkyOverValley() {
  HdrImage image(kSide, kSide);
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
  const HdrImage picture = SkyOverValley();
  const HdrImage exposed = LocallyExposed(picture, 11.0);
  const float before = std::log2(LuminanceAt(picture, 64, 20) / LuminanceAt(picture, 64, 108));
  const float after = std::log2(LuminanceAt(exposed, 64, 20) / LuminanceAt(exposed, 64, 108));
  EXPECT_NEAR(before, 10.0F, 1e-3F);
  EXPECT_NEAR(after, 5.0F, 0.1F) << "the range asked for";
}

TEST(LocalExposure, KeepsTheContrastOfDetail) {
  const HdrImage exposed = LocallyExposed(SkyOverValley(), 11.0);
  for (const int y : {20, 108}) {
    const float contrast = LuminanceAt(exposed, 64, y) / LuminanceAt(exposed, 65, y);
    EXPECT_NEAR(contrast, 1.1F, 0.02F) << "ripples of a tenth stay ripples of a tenth";
  }
}

TEST(LocalExposure, HasNoHaloAlongEdges) {
  const HdrImage exposed = LocallyExposed(SkyOverValley(), 11.0);
  for (int y = 0; y < kSide; ++y) {
    const int far = y < kSide / 2 ? 10 : kSide - 11;
    const int x = (y + far) % 2 == 0 ? 64 : 65;  // the same phase of the ripple
    EXPECT_NEAR(LuminanceAt(exposed, x, y) / LuminanceAt(exposed, 64, far), 1.0F, 0.08F)
        << "row " << y << ": a tenth is where halos begin to be seen";
  }
}

TEST(LocalExposure, KeepsHueAndSmallRanges) {
  const HdrImage exposed = LocallyExposed(SkyOverValley(), 11.0);
  const auto& rgb = exposed.at(30, 90);
  EXPECT_NEAR(rgb[0] / rgb[1], 1.2F, 1e-5F);
  EXPECT_NEAR(rgb[2] / rgb[1], 0.8F, 1e-5F);
  HdrImage flat(16, 16);
  for (int i = 0; i < 256; ++i)
    flat.rgb[static_cast<std::size_t>(i)] = {1.0F + 0.01F * static_cast<float>(i), 1.0F, 1.0F};
  EXPECT_EQ(LocallyExposed(flat, 3.0).rgb, flat.rgb) << "already within five stops";
}

TEST(LocalExposure, KeepsMiddleGrey) {
  HdrImage image(kSide, kSide);
  const auto grey = static_cast<float>(std::exp2(9.0) * kMeterConstant / 100.0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float level = y < 43 ? grey * 64.0F : y < 86 ? grey : grey / 64.0F;
      image.at(x, y) = {level, level, level};
    }
  }
  EXPECT_NEAR(LuminanceAt(LocallyExposed(image, 9.0), 64, 64) / grey, 1.0F, 0.02F);
}

TEST(LocalExposure, KeepsDarknessDarkAndFinite) {
  HdrImage image(32, 32);
  EXPECT_EQ(LocallyExposed(image, 0.0).rgb, image.rgb);
  image.at(3, 3) = {1e5F, 1e5F, 1e5F};
  image.at(4, 4) = {-1.0F, -1.0F, -1.0F};
  for (const auto& rgb : LocallyExposed(image, 0.0).rgb) {
    for (const float channel : rgb) EXPECT_TRUE(std::isfinite(channel));
  }
}

}  // namespace
}  // namespace alpenglow::lut
