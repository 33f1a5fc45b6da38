// SPDX-License-Identifier: MIT
#include "lut/image/look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "lut/image/development.h"
#include "lut/image/metering.h"
#include "lut/image/night_vision.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"
#include "tests/fixtures/flat_picture.h"

namespace alpenglow::lut {
namespace {

TEST(Look, NamesAreCurvesOrLocal) {
  EXPECT_EQ(LookFromName("aces"), (Look{.curve = ToneCurve::kAces}));
  EXPECT_EQ(LookFromName("local"), (Look{.local_exposure = true}));
  EXPECT_THROW((void)LookFromName("dusk"), InputError);
  EXPECT_NE(NameOf(Look{}), NameOf(LookFromName("local")));
}

TEST(Look, IncidentMeterAgreesWithTheSunny16Rule) {
  // Sunlight of 80 to 100 klx: EV 15, f/16 at 1/125 s with ISO 100.
  EXPECT_NEAR(IncidentEv100(82000.0), 15.0, 0.01) << "log2(82000 100 / 250)";
  EXPECT_EQ(IncidentEv100(0.0), kDarkestEv100);
  EXPECT_EQ(IncidentEv100(1e12), kBrightestEv100);
}

// Returns linear display light of what the meter took for middle grey.
double GreyOnTheDisplay(double metered_ev100, double ev100, const Look& look) {
  const double grey = kMeterConstant / 100.0 * std::exp2(metered_ev100);
  return DisplayLight(look.curve, {grey, grey, grey}, ExposureScale(ev100), look.agx)[1];
}

double StopsUnderDay(double metered_ev100, double ev100, const Look& look) {
  return std::log2(GreyOnTheDisplay(15.0, 15.0, look) /
                   GreyOnTheDisplay(metered_ev100, ev100, look));
}

const std::vector<Look> kSomeLooks{{}, {.agx = AgxLook::kNone}, {.curve = ToneCurve::kLinear}};

TEST(Look, EyeLookShowsTheCubeRootOfLuminance) {
  for (const Look& look : kSomeLooks) {
    EXPECT_EQ(EyeEv100(15.0, look), 15.0);
    EXPECT_EQ(EyeEv100(17.0, look), 17.0) << "by day the eye adapts as a camera does";
    for (const double ev100 : {12.0, 8.0, 4.0})
      EXPECT_NEAR(StopsUnderDay(ev100, EyeEv100(ev100, look), look), (15.0 - ev100) / 3.0, 0.2);
    const double night = StopsUnderDay(-8.0, EyeEv100(-8.0, look), look);
    EXPECT_GT(night, 5.0);
    EXPECT_LT(night, 6.0) << "displays lose what is darker";
  }
}

TEST(Look, EyeLookShows20PercentLessLight7PercentDarker) {
  for (double ev100 = 15.0; ev100 > kDarkestEv100 + 1.0; ev100 -= 0.25) {
    const double after = ev100 + std::log2(0.8);
    const double shown = GreyOnTheDisplay(after, EyeEv100(after, {}), {}) /
                         GreyOnTheDisplay(ev100, EyeEv100(ev100, {}), {});
    EXPECT_GT(shown, 0.928) << "0.8^(1/3) at " << ev100;
    EXPECT_LT(shown, 1.0);
  }
}

// The meter reads these values at noon, under a full moon, and under stars alone [EV].
constexpr double kNoonEv100 = 15.0, kFullMoonEv100 = -3.0, kStarlightEv100 = -9.0;

TEST(Look, CameraLookDarkensMoonlightBy4AndStarlightBy6Stops) {
  for (const Look& look : kSomeLooks) {
    EXPECT_EQ(CameraEv100(kNoonEv100, look), kNoonEv100);
    EXPECT_EQ(CameraEv100(17.0, look), 17.0);
    EXPECT_NEAR(StopsUnderDay(kFullMoonEv100, CameraEv100(kFullMoonEv100, look), look), 4.47, 0.05);
    EXPECT_NEAR(StopsUnderDay(kStarlightEv100, CameraEv100(kStarlightEv100, look), look), 6.0, 0.1);
    EXPECT_LT(StopsUnderDay(kDarkestEv100, CameraEv100(kDarkestEv100, look), look), 7.0)
        << "never black";
  }
}

// Krawczyk et al. (2005), equation 11, at 1 cd/m^2 and at 4096: 1.03 - 2 / 2.3010, 1.03 - 2 /
// 5.6125.
TEST(Look, CameraLookUsesThePublishedKeyAtDusk) {
  const double key = 1.03 - 2.0 / (2.0 + std::log10(2.0));
  const double day = 1.03 - 2.0 / (2.0 + std::log10(4097.0));
  EXPECT_NEAR(StopsUnderDay(3.0, CameraEv100(3.0, {}), {}), std::log2(day / key), 0.01)
      << "rods have a 400th of a stop left to say at 200 times their luminance";
}

TEST(Look, EyeAndCameraLooksAreMonotonic) {
  double eye = 1.0, camera = GreyOnTheDisplay(16.0, CameraEv100(16.0, {}), {});
  for (double ev100 = 16.0; ev100 > kDarkestEv100; ev100 -= 0.05) {
    const double by_eye = GreyOnTheDisplay(ev100, EyeEv100(ev100, {}), {});
    const double by_camera = GreyOnTheDisplay(ev100, CameraEv100(ev100, {}), {});
    EXPECT_LE(by_eye, eye * (1.0 + 1e-9)) << ev100;
    EXPECT_LE(by_camera, camera * (1.0 + 1e-9)) << ev100;
    EXPECT_GT(by_camera, 0.97 * camera) << "and makes no step, at " << ev100;
    eye = by_eye;
    camera = by_camera;
  }
}

TEST(Look, IncidentPicturesCompressHighlightsUnlessLinear) {
  const ExposureRule incident{ExposureRule::Kind::kIncident};
  EXPECT_TRUE(LookUnder(incident, {}).rolls_off);
  EXPECT_FALSE(LookUnder(incident, {.curve = ToneCurve::kLinear}).rolls_off);
  EXPECT_FALSE(LookUnder({}, {}).rolls_off);
  HdrImage sky(2, 1);
  sky.rgb = {{1e4F, 1e4F, 1e4F}, {2e4F, 2e4F, 2e4F}};
  const DisplayImage shown = Develop(sky, 12.0, LookUnder(incident, {}));
  EXPECT_EQ(shown.rgb, Develop(WithHighlightsRolledOff(sky, 12.0), 12.0, Look{}).rgb);
}

TEST(Look, ExposureIsMeteredIncidentOrANumber) {
  EXPECT_EQ(ExposureRuleFromText("auto").kind, ExposureRule::Kind::kMetered);
  EXPECT_EQ(ExposureRuleFromText("eye").kind, ExposureRule::Kind::kEye);
  EXPECT_EQ(ExposureRuleFromText("incident").kind, ExposureRule::Kind::kIncident);
  EXPECT_EQ(ExposureRuleFromText("12.5"), (ExposureRule{ExposureRule::Kind::kFixed, 12.5}));
  for (const char* bad : {"", "bright", "31", "1e9", "12 EV"})
    EXPECT_THROW((void)ExposureRuleFromText(bad), InputError) << bad;
}

TEST(Look, DevelopsTheLocallyExposedPicture) {
  HdrImage image(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float level = y < 32 ? 4000.0F : 2.0F;
      image.at(x, y) = {level, level, level};
    }
  }
  const DisplayImage local = Develop(image, 9.0, LookFromName("local"));
  EXPECT_EQ(local.rgb, Develop(LocallyExposed(image, 9.0), 9.0, {.curve = ToneCurve::kAgx}).rgb);
  EXPECT_GT(local.rgb.back(), Develop(image, 9.0, Look{}).rgb.back()) << "shadows are opened";
}

TEST(Look, NightVisionAppliesBeforeMetering) {
  HdrImage image = tests::FlatPicture(4, 4, 1e-3F);
  image.layers.push_back({kScotopicChannel, std::vector<float>(16, 3e-3F)});
  EXPECT_EQ(Seen(image, {}).rgb, image.rgb);
  EXPECT_EQ(Seen(image, {.night_vision = true}).rgb, SeenByNight(image).rgb);
}

// Hard case 44.
TEST(Look, PicturesOfOnePixelOneColumnAndOneLongRowAreDeveloped) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 500}, std::pair{16384, 1}}) {
    // An even grey at dusk, where night vision changes it.
    HdrImage image = tests::FlatPicture(width, height, 0.5F);
    image.layers.push_back({kScotopicChannel, std::vector<float>(image.rgb.size(), 1.0F)});
    for (Look look : {Look{}, LookFromName("local"), Look{.night_vision = true},
                      Look{.local_exposure = true, .night_vision = true}}) {
      look.agx = AgxLook::kNone;
      const HdrImage seen = Seen(image, look);
      EXPECT_EQ(look.night_vision, seen.rgb != image.rgb);
      const DisplayImage display = Develop(seen, MeterEv100(seen, 1e9), look);
      ASSERT_EQ(display.rgb.size(), 3 * image.rgb.size());
      for (std::size_t i = 1; i < display.rgb.size(); i += 3) {
        EXPECT_NEAR(display.rgb[i], 127, look.night_vision ? 12 : 3)
            << width << " x " << height << ", pixel " << i / 3
            << ": middle grey, metered to a 32nd of a stop and dithered; by night it is bluish";
      }
    }
  }
}

WhiteBalance OfKelvin(double kelvin) { return {WhiteBalance::Kind::kKelvin, kelvin}; }

std::array<double, 2> ChromaticityOf(double kelvin) {
  const auto [x, y, z] = WhiteOfTemperature(kelvin);
  return {x / (x + y + z), y / (x + y + z)};
}

HdrImage Uniform(const std::array<double, 3>& rgb, double luminance) {
  HdrImage image(20, 20);
  for (auto& pixel : image.rgb) {
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(luminance * rgb[c]);
  }
  return image;
}

TEST(WhiteBalance, IlluminantsHaveThePublishedChromaticities) {
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

TEST(WhiteBalance, IlluminantsAreContinuousInTemperature) {
  auto before = ChromaticityOf(kWarmestWhite_k);
  for (double mired = 1e6 / kWarmestWhite_k; mired > 1e6 / kCoolestWhite_k; mired -= 1.0) {
    const auto now = ChromaticityOf(1e6 / mired);
    EXPECT_LT(std::hypot(now[0] - before[0], now[1] - before[1]), 3e-3) << 1e6 / mired;
    before = now;
  }
}

TEST(WhiteBalance, TemperatureOfAnIlluminantIsRecovered) {
  for (const double kelvin : {1600.0, 2856.0, 4400.0, 5600.0, 6504.0, 9000.0, 20000.0}) {
    EXPECT_NEAR(1e6 / TemperatureOf(WhiteOfTemperature(kelvin)), 1e6 / kelvin, 0.1)
        << "to a tenth of a mired";
  }
}

TEST(WhiteBalance, PaperUnderTheIlluminantIsWhiteAndEquallyBright) {
  for (const double kelvin : {2000.0, 3000.0, 4500.0, 5600.0, 12000.0}) {
    const HdrImage paper = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(kelvin), 100.0);
    const auto rgb = Balanced(paper, OfKelvin(kelvin)).at(0, 0);
    for (const float channel : rgb) EXPECT_NEAR(channel, 100.0F, 2e-3F) << kelvin << " K";
  }
}

TEST(WhiteBalance, DaylightIsNeutralAndWarmerIlluminantsMakeBluer) {
  const HdrImage grey = Uniform({1.0, 1.0, 1.0}, 100.0);
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

TEST(WhiteBalance, AutoAdaptsToTheMeteredLightAsFarAsCameras) {
  const auto settled = [](double kelvin) {
    const HdrImage image = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(kelvin), 500.0);
    return *Settled({WhiteBalance::Kind::kAuto}, image, Projection::kCamera).kelvin;
  };
  EXPECT_NEAR(settled(4000.0), 4000.0, 5.0) << "a tenth of a mired, and colours are floats";
  EXPECT_NEAR(settled(5600.0), 5600.0, 5.0);
  EXPECT_EQ(settled(2200.0), 3000.0) << "candles stay warm";
  EXPECT_EQ(settled(15000.0), 7000.0) << "a blue sky stays blue";
  EXPECT_NEAR(*Settled({WhiteBalance::Kind::kAuto}, HdrImage(4, 4), Projection::kCamera).kelvin,
              6504.0, 40.0)
      << "no light: D65 of sRGB is off the locus in its fourth digit";
}

TEST(WhiteBalance, AutoIgnoresSunAndLamps) {
  HdrImage image = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(5600.0), 500.0);
  const WhiteBalance ask{WhiteBalance::Kind::kAuto};
  const double without = *Settled(ask, image, Projection::kCamera).kelvin;
  for (int x = 0; x < 10; ++x) image.at(x, 0) = {9e4F, 3e4F, 2e3F};    // 2.5 % of sodium lamps
  for (int x = 0; x < 20; ++x) image.at(x, 1) = {2e9F, 1e9F, 0.3e9F};  // the sun
  EXPECT_NEAR(*Settled(ask, image, Projection::kCamera).kelvin, without, 1.0);
}

TEST(WhiteBalance, CameraIs5500KelvinByDayAnd4000AtNight) {
  EXPECT_EQ(CameraWhite(15.0), kCameraDaylight_k);
  EXPECT_EQ(CameraWhite(4.0), kCameraDaylight_k) << "the end of civil twilight";
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
  EXPECT_EQ(*settled(500.0).kelvin, kCameraDaylight_k);
  EXPECT_NEAR(*settled(1e-3).kelvin, 4000.0, 1e-9);
}

TEST(WhiteBalance, AcceptsCameraDaylightAutoOrKelvin) {
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

TEST(WhiteBalance, IsAppliedToSeenPictures) {
  const HdrImage lit = Uniform(LinearSrgbFromXyz() * WhiteOfTemperature(3000.0), 50.0);
  Look look;
  look.white = {WhiteBalance::Kind::kAuto};
  EXPECT_THROW((void)Seen(lit, look), InternalError) << "auto asks for a picture first";
  const auto rgb = Seen(lit, Settled(look, lit)).at(0, 0);
  EXPECT_NEAR(rgb[0], rgb[2], 0.05F);
}

}  // namespace
}  // namespace alpenglow::lut
