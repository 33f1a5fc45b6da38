// SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/image/eye_adaptation.h"
#include "lut/image/glare.h"
#include "lut/image/night_vision.h"
#include "lut/image/tone_mapping.h"
#include "lut/layer.h"
#include "tests/fixtures/flat_picture.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::lut {
namespace {

constexpr double kRodEfficiency = 683.002 / 1700.0;

// These are the two equations of MES2 as they stand in the publication.
double Unsolved(double m, double photopic, double scotopic) {
  const double luminance =
      (m * photopic + (1.0 - m) * scotopic * kRodEfficiency) / (m + (1.0 - m) * kRodEfficiency);
  return m - std::clamp(0.7670 + 0.3334 * std::log10(luminance), 0.0, 1.0);
}

TEST(NightVision, IsPhotopicByDayAndScotopicInTheDark) {
  for (const double ratio : {0.2, 1.0, 2.5}) {
    const MesopicLight day = MesopicLightOf(20.0, 20.0 * ratio);
    EXPECT_NEAR(day.luminance_cd_per_m2, 20.0, 1e-6) << "above 5 cd/m^2 rods have no part";
    EXPECT_EQ(day.cone_share, 1.0);
    const MesopicLight night = MesopicLightOf(1e-4, 1e-4 * ratio);
    EXPECT_NEAR(night.luminance_cd_per_m2, 1e-4 * ratio, 1e-10) << "below 0.005 cd/m^2 cones";
    EXPECT_EQ(night.cone_share, 0.0);
  }
  EXPECT_EQ(MesopicLightOf(0.0, 0.0).luminance_cd_per_m2, 0.0);
}

TEST(NightVision, SolvesItsEquationsUniquely) {
  for (const double ratio : {0.25, 0.5, 1.0, 2.5, 5.0}) {
    for (double stop = -12.0; stop < 4.0; stop += 0.25) {
      const double photopic = std::exp2(stop);
      const double scotopic = ratio * photopic;
      int solutions = 0;
      double solution = 0.0;
      constexpr int kSteps = 4000;
      double before = Unsolved(0.0, photopic, scotopic);
      if (before == 0.0) ++solutions;
      for (int i = 1; i <= kSteps; ++i) {
        const double m = static_cast<double>(i) / kSteps;
        const double here = Unsolved(m, photopic, scotopic);
        if (before < 0.0 && here >= 0.0) {
          ++solutions;
          solution = m;
        }
        before = here;
      }
      ASSERT_EQ(solutions, 1) << photopic << " cd/m^2, S/P " << ratio;
      const double expected = (solution * photopic + (1.0 - solution) * scotopic * kRodEfficiency) /
                              (solution + (1.0 - solution) * kRodEfficiency);
      EXPECT_NEAR(MesopicLightOf(photopic, scotopic).luminance_cd_per_m2, expected, 1e-3 * expected)
          << "a scan in steps of 1/4000";
    }
  }
}

TEST(NightVision, LuminanceIsContinuousFromDuskToNight) {
  double before = 0.0;
  for (double stop = -14.0; stop < 6.0; stop += 0.01) {
    const double photopic = std::exp2(stop);
    const double luminance = MesopicLightOf(photopic, 2.5 * photopic).luminance_cd_per_m2;
    if (before > 0.0) {
      EXPECT_GT(luminance, before * std::exp2(0.0)) << photopic;
      EXPECT_LT(luminance, before * std::exp2(0.02)) << "a step of 0.01 stops in light";
    }
    before = luminance;
  }
}

HdrImage Uniform(std::array<float, 3> rgb, float scotopic) {
  HdrImage image = tests::FlatPicture(2, 2, rgb);
  image.layers.push_back({kScotopicChannel, std::vector<float>(4, scotopic)});
  return image;
}

TEST(NightVision, KeepsDaylightAndNeedsScotopicLight) {
  const HdrImage day = Uniform({30.0F, 10.0F, 5.0F}, 20.0F);
  EXPECT_EQ(SeenByNight(day).rgb, day.rgb);
  EXPECT_THROW((void)SeenByNight(HdrImage(2, 2)), InputError);
}

TEST(NightVision, RemovesColourAndShiftsTheRestToBlue) {
  // Rods hardly see a red wall of 1e-3 cd/m^2.
  const HdrImage wall = SeenByNight(Uniform({4e-3F, 2e-4F, 1e-4F}, 2e-4F));
  const auto& rgb = wall.at(0, 0);
  EXPECT_NEAR(shared::Luminance<float>(rgb[0], rgb[1], rgb[2]), 2e-4F, 1e-7F)
      << "its luminance is the scotopic one";
  EXPECT_GT(rgb[2], rgb[1]);
  EXPECT_GT(rgb[1], rgb[0]) << "red has become a dark blue grey";
  // Halfway, at 0.2 cd/m^2, some red is left.
  const auto dusk = SeenByNight(Uniform({0.8F, 0.04F, 0.02F}, 0.04F)).at(0, 0);
  EXPECT_GT(dusk[0], dusk[2]);
  EXPECT_LT(dusk[0] / dusk[2], 40.0F) << "less red than by day";
}

TEST(NightVision, IsNeverBrighterThanPhotopicVision) {
  for (double stop = -14.0; stop < 4.0; stop += 0.25) {
    const auto light = static_cast<float>(std::exp2(stop));
    const auto rgb =
        SeenByNight(Uniform({0.5F * light, light, 2.0F * light}, 2.5F * light)).at(0, 0);
    const float photopic = shared::Luminance(0.5F * light, light, 2.0F * light);
    EXPECT_LE(shared::Luminance(rgb[0], rgb[1], rgb[2]), photopic * (1.0F + 2e-4F))
        << "the colour of the rods' white is given to four digits";
  }
}

TEST(EyeAdaptation, FollowsBrighteningAndDuskWithoutALag) {
  EyeAdaptation eye;
  EXPECT_EQ(eye.Follow(-5.0, 0.0), -5.0);
  EXPECT_EQ(eye.Follow(15.0, 1.0), 15.0);
  for (double ev100 = 15.0; ev100 > -5.0; ev100 -= 0.5)
    EXPECT_EQ(eye.Follow(ev100, 60.0), ev100) << "half an EV a minute";
}

// Light falls from daylight to that of a total eclipse within a minute.
TEST(EyeAdaptation, LagsBehindFadingLightButNotAfterBriefShade) {
  EyeAdaptation eye;
  (void)eye.Follow(13.0, 0.0);
  EXPECT_DOUBLE_EQ(eye.Follow(3.0, 60.0), 13.0 - 0.8 - 4.0);
  EXPECT_DOUBLE_EQ(eye.Follow(3.0, 120.0), 13.0 - 3 * 0.8 - 4.0);
  EXPECT_DOUBLE_EQ(eye.Follow(3.0, 600.0), 3.0) << "13 minutes regenerate 10.4 EV";
  EyeAdaptation glance;
  (void)glance.Follow(15.0, 0.0);
  EXPECT_EQ(glance.Follow(11.0, 0.0), 11.0) << "seen at once";
  EXPECT_EQ(glance.Follow(15.0, 0.0), 15.0);
}

constexpr double kPixel_rad = 0.05 * kRadiansPerDegree;

/// Returns upright bars of full contrast, `period` pixels from one to the next.
HdrImage Grating(double mean, double period) {
  HdrImage image(240, 24);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      image.at(x, y).fill(
          static_cast<float>(mean * (1.0 + std::cos(2.0 * kPi * (x + 0.5) / period))));
  }
  return image;
}

/// Returns (largest - smallest) / (largest + smallest) in the middle row.
double ContrastOf(const HdrImage& image) {
  float low = image.at(80, 12)[1], high = low;
  for (int x = 80; x < 160; ++x) {
    low = std::min(low, image.at(x, 12)[1]);
    high = std::max(high, image.at(x, 12)[1]);
  }
  return static_cast<double>((high - low) / (high + low));
}

TEST(Acuity, FallsFromDayToNightAsMeasuredByShlaer) {
  // Shlaer (1937), read from the fit of Ward Larson et al.: 50 by day, 8 by moon, 2 by stars.
  EXPECT_NEAR(AcuityAt(1e3), 49.2, 0.5);
  EXPECT_NEAR(AcuityAt(1.0), 31.5, 0.5);
  EXPECT_NEAR(AcuityAt(0.03), 7.5, 0.5);
  EXPECT_NEAR(AcuityAt(1e-4), 1.7, 0.3);
  EXPECT_GT(AcuityAt(0.0), 0.5);
  for (double stop = -20.0; stop < 14.0; stop += 0.25)
    EXPECT_LE(AcuityAt(std::exp2(stop)), AcuityAt(std::exp2(stop + 0.25)));
}

TEST(Acuity, KeepsSharpnessByDay) {
  const HdrImage bars = Grating(50.0, 6.0);
  HdrImage day = bars;
  for (auto& rgb : day.rgb) rgb.fill(rgb[0] + 5.0F);
  EXPECT_EQ(WithAcuityOfNight(day, kPixel_rad).rgb, day.rgb);
}

TEST(Acuity, FineGratingsFadeInTheDark) {
  for (const double mean : {1e-2, 1e-3, 1e-4}) {
    const double finest_px = 1.0 / (AcuityAt(mean) * kPixel_rad / kRadiansPerDegree);
    const auto left = [&](double period_px) {
      HdrImage bars = Grating(mean, period_px);
      for (auto& rgb : bars.rgb) rgb.fill(0.95F * static_cast<float>(mean) + 0.05F * rgb[0]);
      return ContrastOf(WithAcuityOfNight(bars, kPixel_rad)) / 0.05;
    };
    // One Gaussian would leave 0.1 of the finest. Brighter bars are sharper than those between
    // them.
    EXPECT_GT(left(finest_px), 0.05) << mean << " cd/m^2";
    EXPECT_LT(left(finest_px), 0.4) << mean << " cd/m^2";
    EXPECT_LT(left(0.5 * finest_px), 0.15) << mean << " cd/m^2, a grating twice as fine";
    EXPECT_GT(left(5.0 * finest_px), 0.85) << mean << " cd/m^2: 10^(-1/25) is 0.91";
  }
}

TEST(Acuity, ConservesLightAndAddsNoBrightness) {
  for (const double mean : {1.0, 1e-2, 1e-5}) {
    const HdrImage bars = Grating(mean, 17.0);
    EXPECT_NEAR(tests::MeanLuminance(WithAcuityOfNight(bars, kPixel_rad)),
                tests::MeanLuminance(bars), 1e-5 * mean)
        << "sums of floats";
  }
}

TEST(Acuity, KeepsLampsAsPointsInTheDark) {
  HdrImage image = tests::FlatPicture(61, 41, 1e-4F);
  image.at(30, 20).fill(500.0F);
  const HdrImage seen = WithAcuityOfNight(image, kPixel_rad);
  EXPECT_NEAR(seen.at(30, 20)[1], 500.0F, 1e-2F);
  EXPECT_NEAR(seen.at(31, 20)[1], 1e-4F, 2e-6F)
      << "its neighbour has none of its light, and one of 200 around that lend it theirs less";
}

TEST(Acuity, WorksForOnePixelAndOneRow) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{300, 1}, std::pair{1, 300}}) {
    const HdrImage image = tests::FlatPicture(width, height, 1e-3F);
    for (const auto& rgb : WithAcuityOfNight(image, kPixel_rad).rgb)
      EXPECT_NEAR(rgb[1], 1e-3F, 1e-8F);
  }
}

TEST(Glare, ConservesLight) {
  double sum = 0.0;
  // Steps are even in the logarithm, from a thousandth of the core's width.
  constexpr double kStep = 0.001;
  for (double log_deg = std::log(2e-5); log_deg < std::log(90.0); log_deg += kStep) {
    const double angle = std::exp(log_deg) * kRadiansPerDegree;
    sum += GlareOfEye(angle) * 2.0 * kPi * angle * angle * kStep;
  }
  EXPECT_NEAR(sum, 1.0, 0.01) << "as published, with plane angles for the solid angle";
}

TEST(Glare, IsTheSumOverAllPixels) {
  HdrImage image(13, 9);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      image.at(x, y) = {static_cast<float>(x), static_cast<float>(y + 1), 2.0F};
  }
  image.at(4, 6) = {3e5F, 2e5F, 1e5F};
  const HdrImage seen = WithGlareOfEye(image, kPixel_rad);
  // A pixel keeps all that it does not send to the torus of 32 x 32.
  double sent = 0.0;
  for (int v = -15; v <= 16; ++v) {
    for (int u = -15; u <= 16; ++u) {
      if (u != 0 || v != 0)
        sent += GlareOfEye(kPixel_rad * std::hypot(u, v)) * kPixel_rad * kPixel_rad;
    }
  }
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = (1.0 - sent) * static_cast<double>(image.at(x, y).at(c));
        for (int v = 0; v < image.height; ++v) {
          for (int u = 0; u < image.width; ++u) {
            if (u == x && v == y) continue;
            sum += GlareOfEye(kPixel_rad * std::hypot(u - x, v - y)) * kPixel_rad * kPixel_rad *
                   static_cast<double>(image.at(u, v).at(c));
          }
        }
        EXPECT_NEAR(static_cast<double>(seen.at(x, y).at(c)) / sum, 1.0, 1e-6) << x << " " << y;
      }
    }
  }
}

TEST(Glare, FallsWithTheSquareOfTheAngleFarFromTheSun) {
  HdrImage image(200, 3);
  image.at(0, 1) = {1e9F, 1e9F, 1e9F};
  const HdrImage seen = WithGlareOfEye(image, 0.2 * kRadiansPerDegree);
  const double near = static_cast<double>(seen.at(80, 1)[1]);
  const double far = static_cast<double>(seen.at(160, 1)[1]);
  EXPECT_NEAR(near / far, 4.0, 0.2) << "from 16 to 32 degrees";
}

TEST(Glare, KeepsDarkness) {
  const HdrImage seen = WithGlareOfEye(HdrImage(17, 5), kPixel_rad);
  for (const auto& pixel : seen.rgb) EXPECT_EQ(pixel[1], 0.0F);
}

}  // namespace
}  // namespace alpenglow::lut
