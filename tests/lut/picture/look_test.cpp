// SPDX-License-Identifier: MIT
#include "lut/picture/look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "atmosphere/text/error.h"
#include "lut/picture/local_exposure.h"
#include "lut/picture/night_vision.h"

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

TEST(Look, ExposureIsMeteredIncidentOrANumber) {
  EXPECT_EQ(ExposureRuleFromText("auto").kind, ExposureRule::Kind::kMetered);
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
