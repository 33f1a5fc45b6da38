// SPDX-License-Identifier: MIT
#include "atmosphere/sun/moon_disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"

namespace alpenglow {
namespace {

/// The moon in the east, lit under a phase angle.
MoonDisk AtPhase(double degrees) {
  MoonPosition moon{};
  moon.angular_radius_rad = 0.0045;
  moon.phase_angle_rad = degrees * kRadiansPerDegree;
  moon.sun_distance_au = 1.0;
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
  const double lux = 133e3 * Light(AtPhase(0.0));  // of the sun outside the air: 133,000 lux
  EXPECT_NEAR(lux, 0.32, 0.02) << "V = -12.73, where 1 lux is -13.98 (Allen)";
  const double luminance = 133e3 * MoonRadiance(AtPhase(0.0), Beside(0.0, 0.0));
  EXPECT_NEAR(luminance, 5080.0, 50.0) << "0.12 / pi of the sun's illuminance";
}

TEST(MoonDisk, ItsLightFallsWithThePhaseAsMeasured) {
  const double full = Light(AtPhase(0.0));
  for (const double degrees : {10.0, 45.0, 90.0, 120.0, 145.0}) {
    const double magnitudes = 0.026 * degrees + 4e-9 * std::pow(degrees, 4.0);
    EXPECT_NEAR(Light(AtPhase(degrees)) / full / std::pow(10.0, -0.4 * magnitudes), 1.0, 0.02)
        << "Krisciunas and Schaefer (1991); the sum over a narrow crescent is coarse; " << degrees;
  }
  EXPECT_NEAR(Light(AtPhase(90.0)) / full, 0.091, 0.003) << "a half moon is a tenth";
}

TEST(MoonDisk, IsLitOnTheSideOfTheSunAndBlackOnTheOther) {
  const MoonDisk half = AtPhase(90.0);
  EXPECT_GT(MoonRadiance(half, Beside(0.0, 0.5)), 0.0);
  EXPECT_EQ(MoonRadiance(half, Beside(0.0, -0.5)), 0.0);
  EXPECT_EQ(MoonRadiance(half, Beside(0.3, -0.01)), 0.0);
  EXPECT_GT(MoonRadiance(half, Beside(0.3, 0.02)), 0.0);
  const MoonDisk crescent = AtPhase(150.0);
  EXPECT_EQ(MoonRadiance(crescent, Beside(0.0, 0.8)), 0.0);
  EXPECT_GT(MoonRadiance(crescent, Beside(0.0, 0.95)), 0.0) << "its edge is at cos 30 = 0.87";
}

TEST(MoonDisk, EndsAtItsLimb) {
  const MoonDisk full = AtPhase(0.0);
  EXPECT_GT(MoonRadiance(full, Beside(0.0, 0.99)), 0.0);
  EXPECT_EQ(MoonRadiance(full, Beside(0.0, 1.01)), 0.0);
  EXPECT_EQ(MoonRadiance(full, -Beside(0.0, 0.0)), 0.0) << "behind the eye";
}

TEST(MoonDisk, NewMoonSendsNothing) {
  EXPECT_LT(Light(AtPhase(180.0)), 1e-6 * Light(AtPhase(0.0)));
  EXPECT_TRUE(std::isfinite(AtPhase(180.0).radiance_per_irradiance));
}

}  // namespace
}  // namespace alpenglow
