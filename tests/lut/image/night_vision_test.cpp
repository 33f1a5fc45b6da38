// SPDX-License-Identifier: MIT
#include "lut/image/eye.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/error.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

constexpr double kRodEfficiency = 683.002 / 1700.0;

// The two equations of MES2 as they stand in the publication.
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

TEST(NightVision, SolvesTheEquationsOfTheSystemAndTheyHaveOneSolution) {
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

TEST(NightVision, LuminanceNeverJumpsFromDuskToNight) {
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

Image Uniform(std::array<float, 3> rgb, float scotopic) {
  Image image(2, 2);
  image.rgb.assign(4, rgb);
  image.layers.push_back({kScotopicChannel, std::vector<float>(4, scotopic)});
  return image;
}

TEST(NightVision, LeavesDaylightAloneToTheLastBit) {
  const Image day = Uniform({30.0F, 10.0F, 5.0F}, 20.0F);
  EXPECT_EQ(SeenByNight(day).rgb, day.rgb);
}

TEST(NightVision, TakesColourAwayAndTurnsTheRestBlue) {
  // A red wall of 1e-3 cd/m^2, which rods hardly see.
  const Image wall = SeenByNight(Uniform({4e-3F, 2e-4F, 1e-4F}, 2e-4F));
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

TEST(NightVision, IsNeverBrighterThanWhatConesWouldSee) {
  for (double stop = -14.0; stop < 4.0; stop += 0.25) {
    const auto light = static_cast<float>(std::exp2(stop));
    const auto rgb =
        SeenByNight(Uniform({0.5F * light, light, 2.0F * light}, 2.5F * light)).at(0, 0);
    const float photopic = shared::Luminance(0.5F * light, light, 2.0F * light);
    EXPECT_LE(shared::Luminance(rgb[0], rgb[1], rgb[2]), photopic * (1.0F + 2e-4F))
        << "the colour of the rods' white is given to four digits";
  }
}

TEST(NightVision, NeedsTheLightThatRodsSee) {
  EXPECT_THROW((void)SeenByNight(Image(2, 2)), InputError);
}

}  // namespace
}  // namespace alpenglow::lut
