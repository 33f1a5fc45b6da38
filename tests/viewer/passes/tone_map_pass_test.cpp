// SPDX-License-Identifier: MIT
// Pictures developed and metered on the graphics card.
#include "viewer/passes/display_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <future>
#include <string>
#include <thread>

#include "atmosphere/math/numerics.h"
#include "lut/image/development.h"
#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"
#include "tests/fixtures/flat_picture.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

constexpr int kFrameWidth = 96, kFrameHeight = 54;

/// All hues over twelve stops around 2000 cd/m^2, and some colours out of the display's gamut.
HdrImage Colours() {
  HdrImage image(kFrameWidth, kFrameHeight);
  for (int y = 0; y < kFrameHeight; ++y) {
    for (int x = 0; x < kFrameWidth; ++x) {
      const auto stop = static_cast<float>(12.0 * y / kFrameHeight - 8.0);
      const auto hue = static_cast<float>(6.3 * x / kFrameWidth);
      const float light = 2000.0F * std::exp2(stop);
      image.at(x, y) = {light * (1.0F + 0.9F * std::cos(hue)),
                        light * (1.0F + 0.6F * std::cos(hue + 2.0F)),
                        light * (1.0F + 1.1F * std::cos(hue + 4.0F))};
    }
  }
  return image;
}

using ToneMapPassTest = tests::Headless;

TEST_F(ToneMapPassTest, ToneCurvesEqualTheRenderersWithinOneCode) {
  const HdrImage image = Colours();
  const double ev100 = MeterEv100(image, kSunDiskLuminance_cd_per_m2);
  const RenderTarget picture(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  picture.Write(image);
  const RenderTarget screen(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  ToneMapPass tone_map{Look{}};
  for (const std::string& name : ToneCurveNames()) {
    const ToneCurve curve = ToneCurveFromName(name);
    tone_map.Use(Look{.curve = curve});
    tone_map.Develop(picture, ev100, {screen.framebuffer(), kFrameWidth, kFrameHeight});
    const DisplayImage reference = Develop(image, ev100, {.curve = curve});
    const HdrImage codes = screen.Read();
    int off_by_one = 0;
    for (std::size_t i = 0; i < codes.rgb.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int code = static_cast<int>(std::lround(codes.rgb[i][c] * 255.0F));
        ASSERT_LE(std::abs(code - reference.rgb[3 * i + c]), 1)
            << name << ", pixel " << i << ", channel " << c;
        if (code != reference.rgb[3 * i + c]) ++off_by_one;
      }
    }
    EXPECT_LT(off_by_one, kFrameWidth * kFrameHeight * 3 / 10)
        << "a code falls to the other side as often as the tone table is off, by 0.06 of a code";
  }
}

TEST_F(ToneMapPassTest, ADraftIsOffByAFewCodesBeforeTheTableIsReady) {
  const HdrImage image = Colours();
  const double ev100 = MeterEv100(image, kSunDiskLuminance_cd_per_m2);
  const RenderTarget picture(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  picture.Write(image);
  const RenderTarget screen(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  const DisplayImage reference = Develop(image, ev100, {.curve = ToneCurve::kAgx});
  const ToneMapPass tone_map(Look{}, ToneMapPass::FirstPictures::kDraft);
  const auto most_off = [&] {
    tone_map.Develop(picture, ev100, {screen.framebuffer(), kFrameWidth, kFrameHeight});
    const HdrImage codes = screen.Read();
    int most = 0;
    for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
      const int code = static_cast<int>(std::lround(codes.rgb[i / 3][i % 3] * 255.0F));
      most = std::max(most, std::abs(code - reference.rgb[i]));
    }
    return most;
  };
  const int draft = most_off();
  EXPECT_LE(draft, 9);
  EXPECT_GT(draft, 1) << "or no draft is needed";
  for (int i = 0; i < 6000 && most_off() > 1; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_LE(most_off(), 1);
}

TEST_F(ToneMapPassTest, LooksAndWhiteBalanceEqualTheRenderersWithinOneCode) {
  const HdrImage image = Colours();
  const RenderTarget picture(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  picture.Write(image);
  const RenderTarget screen(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  ToneMapPass tone_map{Look{}};
  for (const AgxLook agx : {AgxLook::kNone, AgxLook::kPunchy, AgxLook::kPhoto}) {
    Look look{.agx = agx};
    look.white = {WhiteBalance::Kind::kKelvin, 4000.0};
    tone_map.Use(look);
    tone_map.Develop(picture, 13.0, {screen.framebuffer(), kFrameWidth, kFrameHeight});
    const DisplayImage reference = Develop(Seen(image, look), 13.0, look),
                       shown = screen.ReadBytes();
    for (std::size_t i = 0; i < reference.rgb.size(); ++i)
      ASSERT_NEAR(shown.rgb[i], reference.rgb[i], 1) << NameOf(agx) << ", byte " << i;
  }
}

TEST_F(ToneMapPassTest, PicturesOfAnySizeFillTheScreen) {
  const std::array<float, 3> sky{500.0F, 800.0F, 1000.0F};
  const RenderTarget picture(8, 8, RenderTarget::Depth::kNone);
  picture.Write(tests::FlatPicture(8, 8, sky));
  const RenderTarget screen(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  ToneMapPass(Look{}).Develop(picture, 12.0, {screen.framebuffer(), kFrameWidth, kFrameHeight});
  const HdrImage even = tests::FlatPicture(kFrameWidth, kFrameHeight, sky);
  const DisplayImage reference = Develop(even, 12.0, {.curve = ToneCurve::kAgx}),
                     shown = screen.ReadBytes();
  for (std::size_t i = 0; i < reference.rgb.size(); ++i)
    ASSERT_NEAR(shown.rgb[i], reference.rgb[i], 1) << "byte " << i;
}

using ExposureMeterTest = tests::Headless;

TEST_F(ExposureMeterTest, AgreesWithTheRenderersMeter) {
  const HdrImage image = Colours();
  const RenderTarget picture(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  picture.Write(image);
  ExposureMeter meter;
  EXPECT_NEAR(meter.Read(picture, {}).ev100, MeterEv100(image, kSunDiskLuminance_cd_per_m2), 0.05)
      << "the copy shows the same picture, upscaled";
  const RenderTarget large(4 * ExposureMeter::kLongSide, 2 * ExposureMeter::kLongSide,
                           RenderTarget::Depth::kNone);
  HdrImage many(large.width(), large.height());
  for (int y = 0; y < many.height; ++y) {
    for (int x = 0; x < many.width; ++x)
      many.at(x, y) = image.at(x * kFrameWidth / many.width, y * kFrameHeight / many.height);
  }
  large.Write(many);
  EXPECT_NEAR(meter.Read(large, {}).ev100, MeterEv100(many, kSunDiskLuminance_cd_per_m2), 0.05)
      << "every fourth pixel of a smooth picture";
}

TEST_F(ExposureMeterTest, WhiteBalanceAgreesWithThatOfASeries) {
  HdrImage image(kFrameWidth, kFrameHeight);
  const auto white = LinearSrgbFromXyz() * WhiteOfTemperature(4200.0);
  for (auto& pixel : image.rgb) {
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(700.0 * white[c]);
  }
  const RenderTarget picture(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  picture.Write(image);
  Look look;
  look.white.kind = WhiteBalance::Kind::kAuto;
  const MeterReading reading = ExposureMeter().Read(picture, look);
  EXPECT_NEAR(*reading.white.kelvin, *Settled(look, image).white.kelvin, 1e-6);
  EXPECT_NEAR(reading.ev100,
              MeterEv100(Seen(image, Settled(look, image)), kSunDiskLuminance_cd_per_m2), 1e-9);
}

TEST_F(ExposureMeterTest, EachReadingArrivesOnce) {
  const RenderTarget picture(kFrameWidth, kFrameHeight, RenderTarget::Depth::kNone);
  picture.Write(Colours());
  ExposureMeter meter;
  EXPECT_FALSE(meter.Poll({}).has_value()) << "nothing was looked at";
  meter.LookAt(picture);
  glFinish();
  const std::optional<MeterReading> arrived = meter.Poll({});
  ASSERT_TRUE(arrived.has_value());
  EXPECT_EQ(arrived->ev100, meter.Read(picture, {}).ev100);
  EXPECT_FALSE(meter.Poll({}).has_value());
}

// --- the table of the tone curve ---

// Trilinear interpolation as a graphics card does it, of a colour in stops over saturation.
std::array<double, 3> CodeOf(const ToneTable& table, const std::array<double, 3>& stops) {
  std::array<int, 3> cell{};
  std::array<double, 3> along{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double range = ToneTable::kHighestStop - ToneTable::kLowestStop;
    const double at = (stops[c] - ToneTable::kLowestStop) / range * (ToneTable::kSide - 1);
    cell[c] = std::clamp(static_cast<int>(at), 0, ToneTable::kSide - 2);
    along[c] = std::clamp(at - cell[c], 0.0, 1.0);
  }
  std::array<double, 3> code{};
  for (int corner = 0; corner < 8; ++corner) {
    std::size_t index = 0;
    double weight = 1.0;
    for (int c = 2; c >= 0; --c) {
      const int step = corner >> c & 1;
      const auto i = static_cast<std::size_t>(c);
      index = index * ToneTable::kSide + static_cast<std::size_t>(cell[i] + step);
      weight *= step == 1 ? along[i] : 1.0 - along[i];
    }
    for (std::size_t c = 0; c < 3; ++c)
      code[c] += weight * static_cast<double>(table.codes()[index][c]);
  }
  return code;
}

/// Returns the errors of the table in codes of 8 bits, in ascending order.
std::vector<double> ErrorsOf(AgxLook look) {
  const std::shared_future<ToneTable> made = ToneTableOf(look);
  const ToneTable& table = made.get();
  std::vector<double> errors;
  for (int i = 1; i <= 20000; ++i) {
    // Colours as nature has them: channels within three stops of each other.
    const double brightness = -10.0 + 14.0 * Halton(i, 2);
    const std::array<double, 3> stops = {brightness, brightness - 1.5 + 3.0 * Halton(i, 3),
                                         brightness - 3.0 + 6.0 * Halton(i, 5)};
    const Rgb<double> light = DisplayLight<double>(
        ToneCurve::kAgx, {std::exp2(stops[0]), std::exp2(stops[1]), std::exp2(stops[2])}, 1.0,
        look);
    const std::array<double, 3> code = CodeOf(table, stops);
    for (std::size_t c = 0; c < 3; ++c)
      errors.push_back(255.0 * std::abs(code[c] - shared::SrgbCode(light[c])));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(ToneTable, ReproducesTheCurveToAFractionOfACode) {
  const std::vector<double> errors = ErrorsOf(AgxLook::kPhoto);
  EXPECT_LT(errors[errors.size() / 2], 0.06);
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.25) << "less than half the dither";
  EXPECT_LT(errors.back(), 0.9);
}

TEST(ToneTable, OtherLooksDeviateOnlyWhereAChannelClips) {
  for (const AgxLook look : {AgxLook::kNone, AgxLook::kPunchy}) {
    const std::vector<double> errors = ErrorsOf(look);
    EXPECT_LT(errors[errors.size() / 2], 0.1) << NameOf(look);
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.5) << NameOf(look);
    EXPECT_LT(errors[errors.size() * 99 / 100], 3.0) << NameOf(look) << ": an edge between nodes";
  }
}

// --- the luminance under the pointer ---

using SpotMeterTest = tests::Headless;

/// Grey, of so many candela per square metre in the upper left and one more from pixel to pixel.
RenderTarget Greys(int width, int height, float first_cd_per_m2) {
  HdrImage image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i].fill(first_cd_per_m2 + static_cast<float>(i));
  RenderTarget target(width, height, RenderTarget::Depth::kNone);
  target.Write(image);
  return target;
}

// Luminance of grey is its value but for the rounding of three weights that add up to one.
constexpr double kRounding = 1e-3;

TEST_F(SpotMeterTest, ReturnsThePointedPixelAsSoonAsItArrives) {
  const RenderTarget picture = Greys(7, 5, 100.0F);
  SpotMeter meter;
  EXPECT_EQ(meter.At(picture, 0.5, 0.5), std::nullopt) << "nothing is waited for";
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.0, 0.0).value(), 100.0 + 2 * 7 + 3, kRounding);
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.999, 0.999).value(), 100.0, kRounding) << "row 0 is the highest";
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.0, 0.0).value(), 100.0 + 34, kRounding);
}

TEST_F(SpotMeterTest, KeepsItsValueUntilTheNextArrivesOrPointingEnds) {
  const RenderTarget picture = Greys(3, 3, 50.0F), other = Greys(3, 3, 900.0F);
  SpotMeter meter;
  static_cast<void>(meter.At(picture, 0.0, 0.0));
  glFinish();
  static_cast<void>(meter.At(other, 0.0, 0.0));
  meter.Leave();
  glFinish();
  EXPECT_EQ(meter.At(picture, 0.9, 0.0), std::nullopt) << "neither of before";
  glFinish();
  EXPECT_NEAR(meter.At(picture, 0.0, 0.0).value(), 52.0, kRounding);
}

}  // namespace
}  // namespace alpenglow::viewer
