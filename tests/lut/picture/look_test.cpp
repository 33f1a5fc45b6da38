// SPDX-License-Identifier: MIT
#include "lut/picture/look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "atmosphere/text/error.h"
#include "lut/picture/local_exposure.h"
#include "lut/picture/night_vision.h"
#include "lut/picture/tone_curve.h"

namespace alpenglow {
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

double GreyOnTheDisplay(double metered_ev100, const Look& look) {
  const double grey = kMeterConstant / 100.0 * std::exp2(metered_ev100);
  return DisplayLight(look.curve, {grey, grey, grey}, ExposureScale(EyeEv100(metered_ev100, look)),
                      look.agx)[1];
}

TEST(Look, ToTheEyeDuskLooksLikeDuskAndNightLikeNight) {
  for (const Look& look :
       {Look{}, Look{.agx = AgxLook::kNone}, Look{.curve = ToneCurve::kLinear}}) {
    EXPECT_EQ(EyeEv100(15.0, look), 15.0);
    EXPECT_EQ(EyeEv100(17.0, look), 17.0) << "by day the eye adapts as a camera does";
    const double day = GreyOnTheDisplay(15.0, look);
    for (const double ev100 : {12.0, 8.0, 2.0, -1.0}) {
      EXPECT_NEAR(std::log2(GreyOnTheDisplay(ev100, look) / day), (ev100 - 15.0) / 3.0, 1e-6)
          << "the cube root of luminance";
    }
    // Sun at -4, -10 and -18 degrees.
    EXPECT_LT(std::log2(GreyOnTheDisplay(7.9, look) / day), -2.0);
    EXPECT_LT(std::log2(GreyOnTheDisplay(-1.0, look) / day), -5.0);
    EXPECT_GT(255.0 * shared::SrgbCode(GreyOnTheDisplay(-8.0, look)), 4.0) << "not black";
  }
}

TEST(Look, ACameraPrintsNightsDarkerThanDaysAndLetsNoLessLightBeBrighter) {
  const auto shown_stops = [](double ev100) { return ev100 - CameraEv100(ev100); };
  EXPECT_EQ(shown_stops(15.0), 0.0);
  EXPECT_EQ(shown_stops(12.0), 0.0);
  EXPECT_NEAR(shown_stops(-2.0), -1.12, 1e-12) << "0.08 (12 + 2): a full moon";
  double before = 16.0 - CameraEv100(16.0);
  for (double ev100 = 15.9; ev100 > kDarkestEv100; ev100 -= 0.1) {
    EXPECT_LE(shown_stops(ev100), before);
    EXPECT_NEAR(shown_stops(ev100), before, 0.0081) << "and makes no step";
    before = shown_stops(ev100);
  }
}

TEST(Look, ToTheEyeLessLightIsNeverBrighter) {
  double before = 1.0;
  for (double ev100 = 16.0; ev100 > -10.0; ev100 -= 0.05) {
    const double now = GreyOnTheDisplay(ev100, {});
    EXPECT_LE(now, before * (1.0 + 1e-9)) << ev100;
    before = now;
  }
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
}  // namespace alpenglow
