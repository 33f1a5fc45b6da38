// SPDX-License-Identifier: MIT
#include "lut/image/look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "lut/image/eye.h"
#include "lut/image/local_exposure.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

TEST(Look, NamesAreCurvesOrLocal) {
  EXPECT_EQ(LookFromName("aces"), (Look{.curve = ToneCurve::kAces}));
  EXPECT_EQ(LookFromName("local"), (Look{.local_exposure = true}));
  EXPECT_THROW((void)LookFromName("dusk"), InputError);
  EXPECT_NE(NameOf(Look{}), NameOf(LookFromName("local")));
}

TEST(Look, IncidentMeterReadsTheSunnySixteenRule) {
  // Sunlight of 80 to 100 klx: EV 15, f/16 at 1/125 s with ISO 100.
  EXPECT_NEAR(IncidentEv100(82000.0), 15.0, 0.01) << "log2(82000 100 / 250)";
  EXPECT_EQ(IncidentEv100(0.0), kDarkestEv100);
  EXPECT_EQ(IncidentEv100(1e12), kBrightestEv100);
}

// Linear display light of what the meter took for middle grey.
double GreyOnTheDisplay(double metered_ev100, double ev100, const Look& look) {
  const double grey = kMeterConstant / 100.0 * std::exp2(metered_ev100);
  return DisplayLight(look.curve, {grey, grey, grey}, ExposureScale(ev100), look.agx)[1];
}

double StopsUnderDay(double metered_ev100, double ev100, const Look& look) {
  return std::log2(GreyOnTheDisplay(15.0, 15.0, look) /
                   GreyOnTheDisplay(metered_ev100, ev100, look));
}

const std::vector<Look> kSomeLooks{{}, {.agx = AgxLook::kNone}, {.curve = ToneCurve::kLinear}};

TEST(Look, ToTheEyeBrightnessIsTheCubeRootOfLuminance) {
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

TEST(Look, ToTheEyeLightThatFalls20PercentIsShown7PercentDarker) {
  for (double ev100 = 15.0; ev100 > kDarkestEv100 + 1.0; ev100 -= 0.25) {
    const double after = ev100 + std::log2(0.8);
    const double shown = GreyOnTheDisplay(after, EyeEv100(after, {}), {}) /
                         GreyOnTheDisplay(ev100, EyeEv100(ev100, {}), {});
    EXPECT_GT(shown, 0.928) << "0.8^(1/3) at " << ev100;
    EXPECT_LT(shown, 1.0);
  }
}

// Metered at noon, under a full moon, and under stars alone [EV].
constexpr double kNoonEv100 = 15.0, kFullMoonEv100 = -3.0, kStarlightEv100 = -9.0;

TEST(Look, ACameraPrintsAFullMoonFourStopsDarkerAndStarsSix) {
  for (const Look& look : kSomeLooks) {
    EXPECT_EQ(CameraEv100(kNoonEv100, look), kNoonEv100);
    EXPECT_EQ(CameraEv100(17.0, look), 17.0);
    EXPECT_NEAR(StopsUnderDay(kFullMoonEv100, CameraEv100(kFullMoonEv100, look), look), 4.47, 0.05);
    EXPECT_NEAR(StopsUnderDay(kStarlightEv100, CameraEv100(kStarlightEv100, look), look), 6.0, 0.1);
    EXPECT_LT(StopsUnderDay(kDarkestEv100, CameraEv100(kDarkestEv100, look), look), 7.0)
        << "never black";
  }
}

// Krawczyk et al. (2005), equation 11, at 1 cd/m^2 and at 4096: 1.03 - 2 / 2.3010, 1.03 - 2 / 5.6125.
TEST(Look, ACameraPrintsDuskByThePublishedKey) {
  const double key = 1.03 - 2.0 / (2.0 + std::log10(2.0));
  const double day = 1.03 - 2.0 / (2.0 + std::log10(4097.0));
  EXPECT_NEAR(StopsUnderDay(3.0, CameraEv100(3.0, {}), {}), std::log2(day / key), 0.01)
      << "rods have a 400th of a stop left to say at 200 times their luminance";
}

TEST(Look, LessLightIsNeverShownBrighterByEyeOrCamera) {
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

TEST(Look, IncidentPicturesRollOffTheirHighlightsButNotLinearOnes) {
  const ExposureRule incident{ExposureRule::Kind::kIncident};
  EXPECT_TRUE(LookUnder(incident, {}).rolls_off);
  EXPECT_FALSE(LookUnder(incident, {.curve = ToneCurve::kLinear}).rolls_off);
  EXPECT_FALSE(LookUnder({}, {}).rolls_off);
  Image sky(2, 1);
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
  Image image(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float level = y < 32 ? 4000.0F : 2.0F;
      image.at(x, y) = {level, level, level};
    }
  }
  const DisplayImage local = Develop(image, 9.0, LookFromName("local"));
  EXPECT_EQ(local.rgb, Develop(LocallyExposed(image, 9.0), 9.0, ToneCurve::kAgx).rgb);
  EXPECT_GT(local.rgb.back(), Develop(image, 9.0, Look{}).rgb.back()) << "shadows are opened";
}

TEST(Look, NightVisionIsSeenBeforeItIsMetered) {
  Image image(4, 4);
  image.rgb.assign(16, {1e-3F, 1e-3F, 1e-3F});
  image.layers.push_back({kScotopicChannel, std::vector<float>(16, 3e-3F)});
  EXPECT_EQ(Seen(image, {}).rgb, image.rgb);
  EXPECT_EQ(Seen(image, {.night_vision = true}).rgb, SeenByNight(image).rgb);
}

// Hard case 44.
TEST(Look, PicturesOfOnePixelOneColumnAndOneLongRowAreDeveloped) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 500}, std::pair{16384, 1}}) {
    // An even grey at dusk, where night vision changes it.
    Image image(width, height);
    for (auto& pixel : image.rgb) pixel = {0.5F, 0.5F, 0.5F};
    image.layers.push_back({kScotopicChannel, std::vector<float>(image.rgb.size(), 1.0F)});
    for (Look look : {Look{}, LookFromName("local"), Look{.night_vision = true},
                      Look{.local_exposure = true, .night_vision = true}}) {
      look.agx = AgxLook::kNone;
      const Image seen = Seen(image, look);
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

}  // namespace
}  // namespace alpenglow::lut
