// SPDX-License-Identifier: MIT
#include "lut/image/tone_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "tests/fixtures/bands_near.h"

namespace alpenglow::lut {
namespace {

using Color = Rgb<double>;

std::vector<ToneCurve> Curves() {
  std::vector<ToneCurve> curves;
  for (const std::string& name : ToneCurveNames()) curves.push_back(ToneCurveFromName(name));
  return curves;
}

/// Returns exposed colours of all kinds: black to 2^40, grey, saturated, out of gamut.
std::vector<Color> Colours() {
  std::vector<Color> colours = {{0.0, 0.0, 0.0}, {-1.0, -1.0, -1.0}, {-0.2, 0.5, 1.0}};
  for (int stop = -20; stop <= 40; ++stop) {
    const double y = std::exp2(stop);
    for (const Color& hue :
         {Color{1.0, 1.0, 1.0}, Color{1.0, 0.0, 0.0}, Color{0.0, 0.0, 1.0}, Color{1.0, 0.5, 0.1},
          Color{0.2, 0.5, 1.0}, Color{-0.1, 0.8, 0.6}, Color{1.0, -0.05, 0.3}}) {
      colours.push_back({y * hue[0], y * hue[1], y * hue[2]});
    }
  }
  return colours;
}

// In Sobotka's configuration 10 of 16.5 stops lie below 0.18, and the curve's pivot is (20/33,
// 0.5).
TEST(Agx, MiddleGreyIsHalfTheCodeRange) {
  const double share = shared::AgxWhiteShare(0.18, 0.18, 0.18);
  EXPECT_NEAR(share, 0.18, 1e-9) << "the shares of the primaries are given to 11 digits";
  EXPECT_NEAR(shared::AgxLogCode(0.18), 20.0 / 33.0, 1e-6)
      << "the published bounds of the encoding have 6 decimals";
  for (const AgxLook look : {AgxLook::kNone, AgxLook::kMedium, AgxLook::kHigh}) {
    EXPECT_NEAR(AgxCodes<double>({0.18, 0.18, 0.18}, GradeOf(look))[1], 0.5, 3e-6)
        << "contrast turns about middle grey";
  }
}

TEST(Agx, SigmoidEndsAtBlackAndWhiteWithSlopeTwoAtItsPivot) {
  EXPECT_NEAR(shared::AgxSigmoid(0.0), 0.0, 1e-12);
  EXPECT_NEAR(shared::AgxSigmoid(1.0), 1.0, 1e-12);
  const double pivot = 20.0 / 33.0;
  const double step = 1e-4;
  const double slope =
      (shared::AgxSigmoid(pivot + step) - shared::AgxSigmoid(pivot - step)) / (2.0 * step);
  EXPECT_NEAR(slope, 2.0, 1e-8) << "the curve departs from its tangent as the fourth power";
}

// Wrensch (2023) fitted the sixth-order polynomial below to the table of AgX, with a published mean
// squared error of 3.7e-6, that is 0.00192 rms.
TEST(Agx, SigmoidAgreesWithThePublishedPolynomialFit) {
  constexpr int kPoints = 1000;
  for (int i = 0; i <= kPoints; ++i) {
    const double x = static_cast<double>(i) / kPoints;
    const double fit = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) -
                       6.868 * std::pow(x, 3) + 0.4298 * x * x + 0.1191 * x - 0.00232;
    EXPECT_NEAR(shared::AgxSigmoid(x), fit, 3.1 * 0.00192)
        << "the extremes of a fit are some three times its rms";
  }
}

// The matrix that is passed around has its white rounded: rows sum to 1 within 1.4e-4.
TEST(Agx, InsetEqualsThePublishedMatrix) {
  const double published[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                  {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                  {0.0423756549057051, 0.0784336, 0.879142973793104}};
  for (int column = 0; column < 3; ++column) {
    const Color unit = {column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0, column == 2 ? 1.0 : 0.0};
    const double share = shared::AgxWhiteShare(unit[0], unit[1], unit[2]);
    for (std::size_t row = 0; row < 3; ++row) {
      EXPECT_NEAR(shared::AgxInset(unit[row], share), published[row][column], 1.4e-4);
    }
  }
}

TEST(Agx, OutsetInvertsTheInset) {
  const Color colour = {0.3, 0.9, 0.05};
  const double share = shared::AgxWhiteShare(colour[0], colour[1], colour[2]);
  Color inset = {};
  for (std::size_t c = 0; c < 3; ++c) inset[c] = shared::AgxInset(colour[c], share);
  const double inset_share = shared::AgxWhiteShare(inset[0], inset[1], inset[2]);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(shared::AgxOutset(inset[c], inset_share), colour[c], 1e-9)
        << "the shares of the primaries sum to 1 within 1e-10";
  }
}

double Hue(const Color& colour) {
  const Oklab<double> lab = OklabOf(colour);
  return std::atan2(lab.b, lab.a) / kRadiansPerDegree;
}

double Chroma(const Color& colour) {
  const Oklab<double> lab = OklabOf(colour);
  return std::hypot(lab.a, lab.b);
}

// A clear sky at noon over a range that is metered at EV 15.3 has this linear light [cd/m^2], 10
// and 20 degrees over the horizon.
const std::vector<Color> kClearSky = {{3203, 5118, 9254}, {2229, 3694, 7288}};

TEST(AgxLooks, PhotoLookKeepsHueAndChromaOfABlueSky) {
  for (const Color& sky : kClearSky) {
    for (const double ev100 : {15.3, 16.0}) {
      const Color photo = DisplayLight(ToneCurve::kAgx, sky, ExposureScale(ev100));
      const Color none = DisplayLight(ToneCurve::kAgx, sky, ExposureScale(ev100), AgxLook::kNone);
      EXPECT_NEAR(Hue(photo), Hue(sky), 1.5) << "what is left of its weight at the border";
      EXPECT_LT(std::abs(Hue(photo) - Hue(sky)), std::abs(Hue(none) - Hue(sky)));
      const double y = shared::Luminance(photo[0], photo[1], photo[2]) /
                       shared::Luminance(sky[0], sky[1], sky[2]);
      const double scene = Chroma({y * sky[0], y * sky[1], y * sky[2]});
      EXPECT_GT(Chroma(photo), scene) << "the scene's chroma at the same luminance";
    }
  }
}

TEST(AgxLooks, WarmLightTurnsYellowAsInAgx) {
  const Color lamp = {3.0, 1.2, 0.3};
  const double turned = Hue(DisplayLight(ToneCurve::kAgx, lamp, 1.0));
  EXPECT_GT(turned, Hue(lamp)) << "90 degrees is OKLab's yellow";
}

// This holds for what is brighter than black by a code, at least, and is not at the border of what
// is shown.
TEST(AgxLooks, ChromaIsAtMost1p3TimesThatOfTheScene) {
  for (const std::string& name : AgxLookNames()) {
    for (const Color& hue : {Color{1.0, 0.7, 0.45}, Color{0.3, 0.5, 1.0}, Color{0.3, 0.45, 0.2},
                             Color{1.0, 0.93, 0.85}, Color{1.0, 0.1, 0.1}}) {
      for (double stop = -10.0; stop <= 6.0; stop += 0.25) {
        const double y = std::exp2(stop);
        const Color light = DisplayLight<double>(
            ToneCurve::kAgx, {y * hue[0], y * hue[1], y * hue[2]}, 1.0, AgxLookFromName(name));
        const double per_scene = OklabOf(light).lightness / OklabOf(hue).lightness;
        EXPECT_LE(Chroma(light), 1.3 * Chroma(hue) * per_scene + 1e-6) << name << ", 2^" << stop;
      }
    }
  }
}

TEST(AgxLooks, RangeFromFlatToContrasty) {
  const auto range = [](AgxLook look) {
    const auto code = [&](double stop) {
      const double y = 0.104 * std::exp2(stop);
      return shared::SrgbCode(DisplayLight<double>(ToneCurve::kAgx, {y, y, y}, 1.0, look)[1]);
    };
    return code(1.5) - code(-1.5);
  };
  EXPECT_LT(range(AgxLook::kNone), range(AgxLook::kMedium));
  EXPECT_LT(range(AgxLook::kMedium), range(AgxLook::kHigh));
  EXPECT_GT(range(AgxLook::kPhoto), range(AgxLook::kMedium));
}

TEST(AgxLooks, PhotoLookHasDeepShadeAndWhiteSnow) {
  const auto code = [](double stop) {
    const double y = 0.125 / 1.2 * std::exp2(stop);
    return 255.0 * shared::SrgbCode(DisplayLight<double>(ToneCurve::kAgx, {y, y, y}, 1.0)[1]);
  };
  EXPECT_LT(code(-2.5), 37.0) << "shade by day, under what the meter took for grey";
  EXPECT_GT(code(-6.0), 2.0) << "and no land is black under a sky of dusk";
  EXPECT_GT(code(1.3), 215.0) << "snow, over it";
  EXPECT_LT(code(4.0), 254.0) << "a bright sky keeps its gradient";
  EXPECT_GT(code(6.5), 254.0);
}

TEST(Agx, ShoulderKeepsContrastNearGreyAndEndsAtWhite) {
  const double grey = 20.0 / 33.0;
  for (const double stops : {0.2, 0.6, 1.1}) {
    const double code = grey + stops / 16.5;
    EXPECT_NEAR((shared::AgxContrastWithShoulder(code, 1.8) - grey) / (1.8 * (code - grey)), 1.0,
                0.01);
  }
  EXPECT_NEAR(shared::AgxContrastWithShoulder(1.0, 1.8), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(shared::AgxContrastWithShoulder(0.5, 1.8), shared::AgxContrast(0.5, 1.8));
}

TEST(AgxLooks, PhotoLookIsLinearInDeepShade) {
  const auto light = [](double stop) {
    const double y = 0.125 / 1.2 * std::exp2(stop);
    return DisplayLight<double>(ToneCurve::kAgx, {y, y, y}, 1.0)[1];
  };
  for (double stop = -9.0; stop < -6.0; stop += 0.5)
    EXPECT_NEAR(std::log2(light(stop + 1.0) / light(stop)), 1.0, 0.06)
        << "what the sigmoid adds to the toe at 2^" << stop;
}

TEST(AgxLooks, UnknownNamesAreRefused) {
  for (const std::string& name : AgxLookNames()) EXPECT_EQ(NameOf(AgxLookFromName(name)), name);
  EXPECT_EQ(AgxLookNames().size(), 5U);
  EXPECT_THROW((void)AgxLookFromName("golden"), InputError);
}

TEST(Oklab, IsInvertibleAndWhiteHasNoChroma) {
  for (const Color& colour : {Color{0.3, 0.9, 0.05}, Color{1e-4, 0.0, 2.0}}) {
    EXPECT_TRUE(tests::BandsNear(RgbOf(OklabOf(colour)), colour, 0.0, 2e-6))
        << "matrices are published to ten digits";
  }
  EXPECT_NEAR(OklabOf(Color{1.0, 1.0, 1.0}).lightness, 1.0, 1e-6);
  EXPECT_NEAR(Chroma({1.0, 1.0, 1.0}), 0.0, 1e-6);
}

TEST(ToneCurves, HaveTheirSpecifiedValues) {
  EXPECT_TRUE(
      tests::BandsNear(NeutralLight<double>({0.7, 0.4, 0.2}), Color{0.66, 0.36, 0.16}, 0.0, 1e-12))
      << "below its knee colours stay, but for the reflection";
  // Grey 1.04: offset 0.04, peak 1, new peak 1 - 0.24^2 / (1 + 0.24 - 0.76) = 0.88.
  EXPECT_NEAR(NeutralLight<double>({1.04, 1.04, 1.04})[1], 0.88, 1e-12);
  EXPECT_NEAR(AcesLight<double>({0.18, 0.18, 0.18})[1], 0.10, 0.01)
      << "the ACES output transform shows 0.18 at 4.8 of 48 cd/m^2; the fit is within a few "
         "percent";
  EXPECT_TRUE(
      tests::BandsNear(ReinhardLight<double>({4.0, 4.0, 4.0}), Color{1.0, 1.0, 1.0}, 0.0, 1e-12))
      << "white";
  for (const double channel : DisplayLight<double>(ToneCurve::kAgx, {3e3, 3e2, 1e2}, 1.0))
    EXPECT_GT(channel, 0.95) << "bright colours go to white";
}

TEST(Reinhard, KeepsTheMappedLuminanceOfSaturatedColours) {
  const Color colour = {2.0, 0.1, 0.05};
  const double y = shared::Luminance(colour[0], colour[1], colour[2]);
  const Color light = ReinhardLight(colour);
  EXPECT_NEAR(shared::Luminance(light[0], light[1], light[2]), shared::ReinhardLuminance(y), 1e-12);
}

void ExpectInRange(const Color& light, const Color& colour) {
  for (const double channel : light) {
    EXPECT_TRUE(channel >= 0.0 && channel <= 1.0)
        << colour[0] << " " << colour[1] << " " << colour[2] << " gave " << channel;
  }
}

// Hard case 34.
TEST(ToneCurves, EveryColourIsFiniteAndInRange) {
  std::vector<Color> colours = Colours();
  const double huge = std::numeric_limits<double>::max();
  colours.push_back({huge, huge, huge});
  colours.push_back({-huge, huge, 1.0});
  colours.push_back({-huge, -huge, -huge});
  for (const ToneCurve curve : Curves()) {
    for (const Color& colour : colours) ExpectInRange(DisplayLight(curve, colour, 1.0), colour);
  }
  for (const std::string& look : AgxLookNames()) {
    for (const Color& colour : colours)
      ExpectInRange(DisplayLight(ToneCurve::kAgx, colour, 1.0, AgxLookFromName(look)), colour);
  }
}

TEST(ToneCurves, GreysStayGreyAndMonotonic) {
  for (const ToneCurve curve : Curves()) {
    double last = -1.0;
    for (double stop = -14.0; stop < 10.0; stop += 0.01) {
      const double y = std::exp2(stop);
      const Color light = DisplayLight<double>(curve, {y, y, y}, 1.0);
      EXPECT_GE(light[1], last) << "at 2^" << stop;
      EXPECT_NEAR(light[0], light[1], 3e-4)
          << "the fits of ACES are given to five decimals, the shares of AgX to eleven";
      EXPECT_NEAR(light[2], light[1], 3e-4);
      last = light[1];
    }
    EXPECT_GT(last, 0.98);
  }
}

TEST(ToneCurves, FloatAgreesWithDouble) {
  for (const ToneCurve curve : Curves()) {
    for (const Color& colour : Colours()) {
      const Rgb<float> single = {static_cast<float>(colour[0]), static_cast<float>(colour[1]),
                                 static_cast<float>(colour[2])};
      const Color light = DisplayLight<double>(
          curve, {double{single[0]}, double{single[1]}, double{single[2]}}, 1.0);
      const Rgb<float> light_single = DisplayLight<float>(curve, single, 1.0F);
      EXPECT_TRUE(tests::BandsNear(light_single, light, 0.0, 5e-6))
          << "a fiftieth of half a code at the slope of the darkest sRGB code";
    }
  }
}

// Hard case 34.
TEST(Gamut, NegativeChannelsAreRemovedAtConstantLuminance) {
  const Color colour = {-0.1, 0.8, 0.6};
  const Color inside = InsideGamut(colour);
  EXPECT_NEAR(inside[0], 0.0, 1e-12);
  EXPECT_NEAR(shared::Luminance(inside[0], inside[1], inside[2]),
              shared::Luminance(colour[0], colour[1], colour[2]), 1e-12);
  EXPECT_EQ(InsideGamut(Color{-1.0, 0.1, 0.0}), (Color{0.0, 0.0, 0.0})) << "no negative light";
  EXPECT_EQ(InsideGamut(Color{0.3, 0.2, 0.1}), (Color{0.3, 0.2, 0.1}));
}

TEST(ToneCurves, MeteredGreyIsDisplayedAsGrey) {
  // A uniform picture of luminance 12.5 / 100 2^EV is metered at EV.
  const double ev100 = 13.0;
  const double metered = 0.125 * std::exp2(ev100);
  const Color grey = {metered, metered, metered};
  const double scale = ExposureScale(ev100);
  EXPECT_NEAR(DisplayLight(ToneCurve::kAgx, grey, scale, AgxLook::kNone)[1], std::pow(0.5, 2.2),
              1e-5)
      << "half the code range of AgX, shown at exponent 2.2";
  // 0.6 of 16.5 stops and a contrast of 1.8, of which the shoulder takes 1.4e-3, in the sigmoid.
  const double opened = shared::AgxSigmoid(20.0 / 33.0 + 1.8 * 0.6 / 16.5);
  EXPECT_NEAR(DisplayLight(ToneCurve::kAgx, grey, scale, AgxLook::kPhoto)[1], std::pow(opened, 2.2),
              5e-3)
      << "a photo is opened by 0.6 stops; its toe adds 0.001";
  EXPECT_NEAR(DisplayLight(ToneCurve::kPbrNeutral, grey, scale)[1], 0.18 - 0.04, 1e-9)
      << "0.18 but for the reflection";
  EXPECT_NEAR(DisplayLight(ToneCurve::kLinear, grey, scale)[1], 0.125 / 1.2, 1e-9)
      << "linear shows the share of saturation";
}

TEST(Srgb, CodeAndLightAreInverse) {
  for (int code = 0; code <= 255; ++code) {
    const double value = code / 255.0;
    EXPECT_NEAR(shared::SrgbCode(shared::SrgbLight(value)), value, 2e-8)
        << "the standard's two pieces meet within 3e-8";
  }
  EXPECT_NEAR(shared::SrgbLight(0.5), 0.21404, 1e-5) << "IEC 61966-2-1";
}

TEST(ToneCurves, UnknownNamesAreRefused) {
  EXPECT_EQ(ToneCurveFromName("agx"), ToneCurve::kAgx);
  EXPECT_EQ(ToneCurveFromName("pbr-neutral"), ToneCurve::kPbrNeutral);
  EXPECT_THROW((void)ToneCurveFromName("filmic"), InputError);
}

}  // namespace
}  // namespace alpenglow::lut
