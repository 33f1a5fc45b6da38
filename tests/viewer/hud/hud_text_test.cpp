// SPDX-License-Identifier: MIT
#include "lut/image/tone_mapping.h"
#include "viewer/hud/hud_model.h"

#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

double Radians(double degrees) { return degrees * kRadiansPerDegree; }

TEST(HudText, PlacesNameTheirHemisphere) {
  EXPECT_EQ(LatitudeText(Radians(46.5)), "46.5000° N");
  EXPECT_EQ(LatitudeText(Radians(-33.0)), "33.0000° S");
  EXPECT_EQ(LongitudeText(Radians(-8.25)), "8.2500° W");
  EXPECT_EQ(LongitudeText(Radians(179.9)), "179.9000° E");
}

TEST(HudText, HeadingsAreThreeDigitsBelow360) {
  EXPECT_EQ(HeadingText(Radians(7.2)), "007");
  EXPECT_EQ(HeadingText(Radians(-90.0)), "270");
  EXPECT_EQ(HeadingText(Radians(359.7)), "000") << "not 360";
  EXPECT_EQ(HeadingText(Radians(725.0)), "005");
}

TEST(HudText, NothingIsMinusZero) {
  EXPECT_EQ(DegreesText(Radians(-0.04)), "+0.0°");
  EXPECT_EQ(HeightText(-0.3, HudUnits::kMetric).number, "0");
  EXPECT_EQ(ClimbText(-0.01, HudUnits::kMetric).number, "+0.0");
  EXPECT_EQ(ClimbText(-0.001, HudUnits::kAviation).number, "+0");
}

TEST(HudText, HeightsAndSpeedsFromTheGroundToOrbit) {
  EXPECT_EQ(Joined(HeightText(3241.7, HudUnits::kMetric)), "3242 m");
  EXPECT_EQ(Joined(HeightText(408e3, HudUnits::kMetric)), "408.0 km");
  EXPECT_EQ(Joined(HeightText(304.8, HudUnits::kAviation)), "1000 ft");
  EXPECT_EQ(Joined(SpeedText(10.0, HudUnits::kMetric)), "36 km/h");
  EXPECT_EQ(Joined(SpeedText(7660.0, HudUnits::kMetric)), "7.7 km/s");
  EXPECT_EQ(Joined(SpeedText(51.4444, HudUnits::kAviation)), "100 kt");
  EXPECT_EQ(Joined(ClimbText(5.08, HudUnits::kAviation)), "+1000 ft/min");
}

TEST(HudText, UnitsSayHowManyOfThemAreOneOfSi) {
  for (const HudUnits units : {HudUnits::kMetric, HudUnits::kAviation}) {
    for (const double value : {120.0, 3e5}) {
      const Quantity height = HeightText(value, units), speed = SpeedText(value, units);
      EXPECT_NEAR(std::stod(height.number), value * height.per_si, 0.5) << "rounded to whole ones";
      EXPECT_NEAR(std::stod(speed.number), value * speed.per_si, 0.5);
    }
  }
}

TEST(HudText, LuminancesHaveThreeDigitsThatCount) {
  EXPECT_EQ(LuminanceText(8213.0), "8210 cd/m²");
  EXPECT_EQ(LuminanceText(0.0123456), "0.0123 cd/m²");
  EXPECT_EQ(LuminanceText(1.0), "1.00 cd/m²");
  EXPECT_EQ(LuminanceText(0.0), "0.00e+00 cd/m²");
  EXPECT_EQ(LuminanceText(1.6e9), "1.60e+09 cd/m²") << "the sun's disk";
}

TEST(HudText, RatesOfTimeAreFactors) {
  EXPECT_EQ(RateText(1.0, false), "x1");
  EXPECT_EQ(RateText(-3600.0, false), "x-3600");
  EXPECT_EQ(RateText(0.5, false), "x0.5");
  EXPECT_EQ(RateText(60.0, true), "paused");
}

TEST(HudTheme, TheNightIsDimAndHasNoBlue) {
  const HudColours &day = ColoursOf(HudTheme::kDay), &night = ColoursOf(HudTheme::kNight);
  for (const HudColour& colour : {night.text, night.quiet, night.accent, night.warning, night.plate,
                                  night.panel, night.control, night.active}) {
    EXPECT_LT(colour[2], 0.1F);
    EXPECT_LT(colour[1], 0.5F * day.text[1]);
    EXPECT_GE(colour[0], colour[1]);
  }
}

double LuminanceOf(const HudColour& colour) {
  return shared::Luminance<double>(shared::SrgbLight(double{colour[0]}),
                                   shared::SrgbLight(double{colour[1]}),
                                   shared::SrgbLight(double{colour[2]}));
}

HudColour Over(const HudColour& behind, const HudColour& plate) {
  HudColour seen = behind;
  for (std::size_t c = 0; c < 3; ++c) seen[c] += plate[3] * (plate[c] - behind[c]);
  return seen;
}

double ContrastOf(const HudColour& text, const HudColour& behind) {
  return (LuminanceOf(text) + 0.05) / (LuminanceOf(behind) + 0.05);
}

constexpr HudColour kWhite{1.0F, 1.0F, 1.0F, 1.0F};

TEST(HudTheme, WhatIsWrittenOnAPlateIsReadableOverWhite) {
  for (const HudTheme theme : {HudTheme::kDay, HudTheme::kNight}) {
    const HudColours& colours = ColoursOf(theme);
    for (const HudColour& colour : {colours.text, colours.quiet, colours.accent, colours.warning}) {
      for (const HudColour& plate : {colours.plate, colours.panel})
        EXPECT_GE(ContrastOf(colour, Over(kWhite, plate)), 4.5) << colour[0] << " " << colour[1];
    }
  }
}

TEST(HudTheme, WhatIsWrittenOnControlsIsReadableOverWhite) {
  for (const HudTheme theme : {HudTheme::kDay, HudTheme::kNight}) {
    const HudColours& colours = ColoursOf(theme);
    const HudColour control = Over(Over(kWhite, colours.panel), colours.control);
    for (const HudColour& behind : {control, Over(control, colours.active)})
      EXPECT_GE(ContrastOf(colours.text, behind), 4.5) << behind[0] << " " << behind[1];
    EXPECT_GE(ContrastOf(colours.quiet, control), 4.5) << "hints in fields";
  }
}

TEST(HudTheme, ADuskDoesNotFlicker) {
  const auto follow = [](std::initializer_list<double> exposures) {
    HudTheme theme = HudTheme::kDay;
    int changes = 0;
    for (const double ev100 : exposures) {
      const HudTheme next = ThemeFor(HudThemeChoice::kAuto, ev100, theme);
      changes += next == theme ? 0 : 1;
      theme = next;
    }
    return changes;
  };
  EXPECT_EQ(follow({15.0, 5.0, 0.9, 1.4, 0.8, 2.5, -4.0}), 1);
  EXPECT_EQ(follow({15.0, 0.0, 2.0, 3.1, 2.0, 1.1}), 2) << "down and up again";
  EXPECT_EQ(ThemeFor(HudThemeChoice::kNight, 15.0, HudTheme::kDay), HudTheme::kNight);
  EXPECT_EQ(ThemeFor(HudThemeChoice::kDay, -6.0, HudTheme::kNight), HudTheme::kDay);
}

}  // namespace
}  // namespace alpenglow::viewer
