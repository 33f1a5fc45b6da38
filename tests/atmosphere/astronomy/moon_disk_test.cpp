// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/moon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

/// The moon in the east, lit under a phase angle.
MoonDisk AtPhase(double degrees) {
  MoonPosition moon{};
  moon.angular_radius_rad = 0.0045;
  moon.phase_angle_rad = degrees * kRadiansPerDegree;
  moon.sun_distance_au = 1.0;
  moon.distance_m = 384.4e6;
  const double a = moon.phase_angle_rad;
  return MoonDiskOf(moon, {1.0, 0.0, 0.0}, {-std::cos(a), 0.0, std::sin(a)}, 1.0);
}

/// A direction so many radii beside the disk's centre, to the left and up.
glm::dvec3 Beside(double left, double up) {
  return glm::normalize(glm::dvec3(1.0, 0.0045 * left, 0.0045 * up));
}

/// Irradiance of the disk, per unit of the sun's.
double Light(const MoonDisk& moon) {
  constexpr int kSide = 400;
  constexpr double kStep = 2.0 / kSide;
  double sum = 0.0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j)
      sum += MoonRadiance(moon, Beside((i + 0.5) * kStep - 1.0, (j + 0.5) * kStep - 1.0));
  }
  return sum * kStep * kStep * 0.0045 * 0.0045;
}

TEST(MoonDisk, FullMoonIsAThirdOfALux) {
  const double lux = 133e3 * Light(AtPhase(5.0));  // of the sun outside the air: 133,000 lux
  EXPECT_NEAR(lux, 0.32 * std::pow(10.0, -0.4 * 0.13), 0.02)
      << "V = -12.73 + 0.026 a, where 1 lux is -13.98 (Allen)";
}

TEST(MoonDisk, ItsLightFallsWithThePhaseAsOthersMeasured) {
  for (const double degrees : {7.0, 10.0, 30.0, 45.0, 90.0, 120.0, 145.0}) {
    const double magnitudes = 3.84 + 0.026 * degrees + 4e-9 * std::pow(degrees, 4.0);
    const double lux = 10.764 * std::pow(10.0, -0.4 * magnitudes);  // from foot-candles
    EXPECT_NEAR(133e3 * Light(AtPhase(degrees)) / lux, 1.0, 0.12)
        << "Krisciunas and Schaefer (1991), equation 20, who give 0.1 magnitudes; " << degrees;
  }
  EXPECT_NEAR(Light(AtPhase(90.0)) / Light(AtPhase(3.0)), 0.088, 0.01) << "a tenth, at half moon";
}

TEST(MoonDisk, SurgesAtOpposition) {
  const double steady = Light(AtPhase(10.0)) * std::pow(10.0, 0.4 * 0.026 * 8.5);
  EXPECT_GT(Light(AtPhase(1.5)) / steady, 1.1);
  EXPECT_LT(Light(AtPhase(1.5)) / steady, 1.35)
      << "up to 35 %: Krisciunas and Schaefer (1991), section 3";
}

TEST(MoonDisk, ItsLightIsThatOfItsRadiance) {
  MoonPosition moon{};
  moon.angular_radius_rad = 0.0045;
  moon.sun_distance_au = 1.01;
  moon.phase_angle_rad = 1.0;
  moon.distance_m = 384.4e6;
  const MoonDisk disk =
      MoonDiskOf(moon, {1.0, 0.0, 0.0}, {-std::cos(1.0), 0.0, std::sin(1.0)}, 1.0);
  EXPECT_NEAR(Light(disk) / MoonIrradiance(moon, 1.0, 550.0), 1.0, 0.005)
      << "the sum over the disk is coarse, and earthshine is not in the light: 0.0003";
}

TEST(MoonDisk, ItsLightIsRedderThanTheSuns) {
  MoonPosition moon{};
  moon.angular_radius_rad = 0.0045;
  moon.sun_distance_au = 1.0;
  moon.phase_angle_rad = 0.1;
  EXPECT_NEAR(MoonIrradiance(moon, 1.0, 650.0) / MoonIrradiance(moon, 1.0, 450.0), 1.4, 0.1)
      << "B - V of the moon 0.92, of the sun 0.65 (Allen): 1.28 from 440 to 550 nm";
}

TEST(MoonDisk, TheDarkSideOfACrescentIsLitByTheEarth) {
  const MoonDisk crescent = AtPhase(150.0);
  const double luminance = 133e3 * MoonRadiance(crescent, Beside(0.0, 0.0));
  EXPECT_GT(luminance, 0.3) << "12 to 13 magnitudes below full sunlight, 5000 cd/m^2:";
  EXPECT_LT(luminance, 1.0) << "Danjon's ashen light";
  EXPECT_LT(MoonRadiance(AtPhase(20.0), Beside(0.0, 0.9)),
            1.1 * AtPhase(20.0).radiance_per_irradiance)
      << "gone by full moon";
}

TEST(MoonDisk, IsLitOnTheSideOfTheSunAndDarkOnTheOther) {
  const MoonDisk half = AtPhase(90.0);
  EXPECT_GT(MoonRadiance(half, Beside(0.0, 0.5)), 100.0 * half.earthshine_per_irradiance);
  EXPECT_EQ(MoonRadiance(half, Beside(0.0, -0.5)), half.earthshine_per_irradiance);
  EXPECT_EQ(MoonRadiance(half, Beside(0.3, -0.01)), half.earthshine_per_irradiance);
  EXPECT_GT(MoonRadiance(half, Beside(0.3, 0.02)), 10.0 * half.earthshine_per_irradiance);
  const MoonDisk crescent = AtPhase(150.0);
  EXPECT_EQ(MoonRadiance(crescent, Beside(0.0, 0.8)), crescent.earthshine_per_irradiance);
  EXPECT_GT(MoonRadiance(crescent, Beside(0.0, 0.95)), 10.0 * crescent.earthshine_per_irradiance)
      << "its edge is at cos 30 = 0.87";
}

TEST(MoonDisk, EndsAtItsLimb) {
  const MoonDisk full = AtPhase(0.0);
  EXPECT_GT(MoonRadiance(full, Beside(0.0, 0.99)), 0.0);
  EXPECT_EQ(MoonRadiance(full, Beside(0.0, 1.01)), 0.0);
  EXPECT_EQ(MoonRadiance(full, -Beside(0.0, 0.0)), 0.0) << "behind the eye";
}

TEST(MoonDisk, NewMoonSendsNothingButEarthshine) {
  const double full = Light(AtPhase(0.0));
  EXPECT_NEAR(Light(AtPhase(180.0)) / full, 1.0e-4, 0.1e-4) << "0.37 (6371 / 384400)^2";
  EXPECT_TRUE(std::isfinite(AtPhase(180.0).radiance_per_irradiance));
}

}  // namespace
}  // namespace alpenglow::atmosphere
