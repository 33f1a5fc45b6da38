// SPDX-License-Identifier: MIT
#include "lut/image/eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "atmosphere/math/constants.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

constexpr double kPixel_rad = 0.05 * kRadiansPerDegree;

double MeanOf(const Image& image) {
  double sum = 0.0;
  for (const auto& rgb : image.rgb) sum += shared::Luminance<double>(rgb[0], rgb[1], rgb[2]);
  return sum / static_cast<double>(image.rgb.size());
}

/// Upright bars of full contrast, `period` pixels from one to the next.
Image Grating(double mean, double period) {
  Image image(240, 24);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      image.at(x, y).fill(
          static_cast<float>(mean * (1.0 + std::cos(2.0 * kPi * (x + 0.5) / period))));
  }
  return image;
}

/// (largest - smallest) / (largest + smallest) in the middle row.
double ContrastOf(const Image& image) {
  float low = image.at(80, 12)[1], high = low;
  for (int x = 80; x < 160; ++x) {
    low = std::min(low, image.at(x, 12)[1]);
    high = std::max(high, image.at(x, 12)[1]);
  }
  return static_cast<double>((high - low) / (high + low));
}

TEST(Acuity, FallsFromDayToNightAsShlaerMeasured) {
  // Shlaer (1937), read from the fit of Ward Larson et al.: 50 by day, 8 by moon, 2 by stars.
  EXPECT_NEAR(AcuityAt(1e3), 49.2, 0.5);
  EXPECT_NEAR(AcuityAt(1.0), 31.5, 0.5);
  EXPECT_NEAR(AcuityAt(0.03), 7.5, 0.5);
  EXPECT_NEAR(AcuityAt(1e-4), 1.7, 0.3);
  EXPECT_GT(AcuityAt(0.0), 0.5);
  for (double stop = -20.0; stop < 14.0; stop += 0.25)
    EXPECT_LE(AcuityAt(std::exp2(stop)), AcuityAt(std::exp2(stop + 0.25)));
}

TEST(Acuity, DayIsAsSharpAsItWas) {
  const Image bars = Grating(50.0, 6.0);
  Image day = bars;
  for (auto& rgb : day.rgb) rgb.fill(rgb[0] + 5.0F);
  EXPECT_EQ(WithAcuityOfNight(day, kPixel_rad).rgb, day.rgb);
}

TEST(Acuity, InTheDarkFineGratingsFadeAndCoarseOnesDoNot) {
  for (const double mean : {1e-2, 1e-3, 1e-4}) {
    const double finest_px = 1.0 / (AcuityAt(mean) * kPixel_rad / kRadiansPerDegree);
    const auto left = [&](double period_px) {
      Image bars = Grating(mean, period_px);
      for (auto& rgb : bars.rgb) rgb.fill(0.95F * static_cast<float>(mean) + 0.05F * rgb[0]);
      return ContrastOf(WithAcuityOfNight(bars, kPixel_rad)) / 0.05;
    };
    // One Gaussian would leave 0.1 of the finest. Brighter bars are sharper than those between them.
    EXPECT_GT(left(finest_px), 0.05) << mean << " cd/m^2";
    EXPECT_LT(left(finest_px), 0.4) << mean << " cd/m^2";
    EXPECT_LT(left(0.5 * finest_px), 0.15) << mean << " cd/m^2, a grating twice as fine";
    EXPECT_GT(left(5.0 * finest_px), 0.85) << mean << " cd/m^2: 10^(-1/25) is 0.91";
  }
}

TEST(Acuity, NothingIsLostAndNothingGrowsBrighter) {
  for (const double mean : {1.0, 1e-2, 1e-5}) {
    const Image bars = Grating(mean, 17.0);
    EXPECT_NEAR(MeanOf(WithAcuityOfNight(bars, kPixel_rad)), MeanOf(bars), 1e-5 * mean)
        << "sums of floats";
  }
}

TEST(Acuity, ALampStaysAPointInTheDark) {
  Image image(61, 41);
  for (auto& rgb : image.rgb) rgb.fill(1e-4F);
  image.at(30, 20).fill(500.0F);
  const Image seen = WithAcuityOfNight(image, kPixel_rad);
  EXPECT_NEAR(seen.at(30, 20)[1], 500.0F, 1e-2F);
  EXPECT_NEAR(seen.at(31, 20)[1], 1e-4F, 2e-6F)
      << "its neighbour has none of its light, and one of 200 around that lend it theirs less";
}

TEST(Acuity, PicturesOfOnePixelOrOneRowAreSeen) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{300, 1}, std::pair{1, 300}}) {
    Image image(width, height);
    for (auto& rgb : image.rgb) rgb.fill(1e-3F);
    for (const auto& rgb : WithAcuityOfNight(image, kPixel_rad).rgb)
      EXPECT_NEAR(rgb[1], 1e-3F, 1e-8F);
  }
}

}  // namespace
}  // namespace alpenglow::lut
