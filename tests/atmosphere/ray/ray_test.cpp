// SPDX-License-Identifier: MIT
#include "atmosphere/ray/ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kRadius_m = 6.371e6;
constexpr double kTop_m = 120e3;

// Hard case 1.
TEST(Ray, HorizontalOnTheGroundLeavesForSpace) {
  const RayExtent extent = ExtentOf({0.0, 0.0, 1.0, 0.0}, kRadius_m, kTop_m);
  EXPECT_EQ(extent.end, RayEnd::kSpace);
  EXPECT_NEAR(extent.end_m, std::sqrt(kTop_m * (2.0 * kRadius_m + kTop_m)), 1e-6)
      << "the tangent to the top";
}

// Hard case 1.
TEST(Ray, JustBelowTheHorizontalOnTheGroundHitsItAtOnce) {
  const RayExtent extent = ExtentOf({0.0, -1e-12, 1.0, 0.0}, kRadius_m, kTop_m);
  EXPECT_EQ(extent.end, RayEnd::kGround);
  EXPECT_EQ(extent.end_m, 0.0);
}

// Hard case 7.
TEST(Ray, HorizonSeparatesGroundFromSkyWithinOneUlp) {
  for (const double h : {0.01, 2.0, 1e3, 1e4, 1e5, 4e5}) {
    const double horizon = -std::sqrt(h * (2.0 * kRadius_m + h)) / (kRadius_m + h);
    const double below = std::nextafter(std::nextafter(horizon, -1.0), -1.0);
    const double above = std::nextafter(std::nextafter(horizon, 1.0), 1.0);
    EXPECT_EQ(ExtentOf({h, below, 1.0, 0.0}, kRadius_m, kTop_m).end, RayEnd::kGround) << h;
    EXPECT_NE(ExtentOf({h, above, 1.0, 0.0}, kRadius_m, kTop_m).end, RayEnd::kGround) << h;
  }
}

// Hard case 5.
TEST(Ray, FromSpaceMissesGrazesOrEnters) {
  const double h = 4e5;
  const double grazing =
      -std::sqrt((h - kTop_m) * (2.0 * kRadius_m + h + kTop_m)) / (kRadius_m + h);
  const RayExtent miss = ExtentOf({h, grazing + 1e-9, 1.0, 0.0}, kRadius_m, kTop_m);
  EXPECT_EQ(miss.begin_m, miss.end_m);
  const RayExtent enter = ExtentOf({h, grazing - 1e-9, 1.0, 0.0}, kRadius_m, kTop_m);
  EXPECT_GT(enter.begin_m, 0.0);
  EXPECT_GT(enter.end_m, enter.begin_m);
  const RayExtent down = ExtentOf({h, -1.0, 1.0, -1.0}, kRadius_m, kTop_m);
  EXPECT_NEAR(down.begin_m, h - kTop_m, 1e-6);
  EXPECT_NEAR(down.end_m, h, 1e-6);
  EXPECT_EQ(down.end, RayEnd::kGround);
}

// Hard case 2.
TEST(Ray, BelowTheSphereSeesTheSkyOfTheGround) {
  const RayExtent sunken = ExtentOf({-430.0, 0.5, 1.0, 0.5}, kRadius_m, kTop_m);
  const RayExtent ground = ExtentOf({0.0, 0.5, 1.0, 0.5}, kRadius_m, kTop_m);
  EXPECT_EQ(sunken.end_m, ground.end_m);
}

TEST(Ray, GivenLengthEndsItUnlessTheGroundIsNearer) {
  EXPECT_EQ(ExtentOf({100.0, 0.2, 1.0, 0.2, 5000.0}, kRadius_m, kTop_m).end, RayEnd::kLength);
  EXPECT_EQ(ExtentOf({100.0, -1.0, 1.0, -1.0, 5000.0}, kRadius_m, kTop_m).end, RayEnd::kGround);
  EXPECT_EQ(ExtentOf({100.0, 0.2, 1.0, 0.2, 0.0}, kRadius_m, kTop_m).end_m, 0.0);
}

// Hard case 39.
TEST(Ray, AShortRayThatComesNearGroundOrTopEndsThereOnlyIfItReachesThem) {
  constexpr double kFrom_m = 200.0;
  for (const double perigee_m : {-2.0, -0.5, 0.5, 2.0, 50.0}) {
    // Down to the perigee and up again.
    const double sine = (kRadius_m + perigee_m) / (kRadius_m + kFrom_m);
    const double mu = -std::sqrt((1.0 - sine) * (1.0 + sine));
    const double deepest_m = -(kRadius_m + kFrom_m) * mu;
    const ViewRay through{kFrom_m, mu, 1.0, 0.0, 1.5 * deepest_m};
    const RayExtent extent = ExtentOf(through, kRadius_m, kTop_m);
    EXPECT_EQ(extent.end == RayEnd::kGround, perigee_m < 0.0) << perigee_m;
    EXPECT_EQ(extent.end_m == through.length_m, perigee_m > 0.0);
  }
  for (const double over_m : {-2.0, -0.5, 0.5, 2.0}) {
    const ViewRay up{kTop_m - 500.0, 1.0, 1.0, 1.0, 500.0 + over_m};
    EXPECT_EQ(ExtentOf(up, kRadius_m, kTop_m).end == RayEnd::kSpace, over_m > 0.0) << over_m;
  }
}

// Hard case 3.
TEST(Ray, NotANumberAndTheCentreOfThePlanetAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)ExtentOf({nan, 0.0, 1.0, 0.0}, kRadius_m, kTop_m), InputError);
  EXPECT_THROW((void)ExtentOf({-kRadius_m, 0.0, 1.0, 0.0}, kRadius_m, kTop_m), InputError);
  EXPECT_THROW((void)ExtentOf({0.0, nan, 1.0, 0.0}, kRadius_m, kTop_m), InputError);
  EXPECT_THROW((void)ExtentOf({0.0, 0.0, 1.0, 0.0, -1.0}, kRadius_m, kTop_m), InputError);
}

TEST(PlanetShadow, ZenithViewEntersLightWhereTheShadowEnds) {
  // Sun e below the horizon: the shadow reaches R (1 / cos e - 1) over the observer.
  const double e = 0.1;
  const ViewRay ray{0.0, 1.0, -std::sin(e), -std::sin(e)};
  const ShadowSpan shadow = PlanetShadow(ray, ExtentOf(ray, kRadius_m, kTop_m), kRadius_m);
  EXPECT_EQ(shadow.dark_begin_m, 0.0);
  EXPECT_NEAR(shadow.dark_end_m, kRadius_m * (1.0 / std::cos(e) - 1.0), 1e-5) << "closed form";
}

TEST(PlanetShadow, NoneByDay) {
  const ViewRay ray{0.0, 0.3, 0.5, 0.9};
  const ShadowSpan shadow = PlanetShadow(ray, ExtentOf(ray, kRadius_m, kTop_m), kRadius_m);
  EXPECT_EQ(shadow.dark_begin_m, shadow.dark_end_m);
}

TEST(PlanetShadow, LookingAlongTheShadowAxisIsDarkToTheEnd) {
  const ViewRay ray{4e5, 1.0, -1.0, -1.0};
  const RayExtent extent{0.0, 1e6, RayEnd::kLength};
  const ShadowSpan shadow = PlanetShadow(ray, extent, kRadius_m);
  EXPECT_EQ(shadow.dark_begin_m, 0.0) << "behind the planet, away from the sun";
  EXPECT_EQ(shadow.dark_end_m, 1e6);
}

// Points of a ray that the planet hides from the sun, from the positions themselves.
bool IsDark(const ViewRay& ray, double distance_m) {
  const double along = std::sqrt((1.0 - ray.mu) * (1.0 + ray.mu));
  const double sun_x = (ray.nu - ray.mu * ray.mu_s) / along;
  const long double x = static_cast<long double>(along) * distance_m;
  const long double z = static_cast<long double>(ray.mu) * distance_m + kRadius_m + ray.altitude_m;
  const long double towards_sun = sun_x * x + ray.mu_s * z;
  const long double off_axis2 = x * x + z * z - towards_sun * towards_sun;
  return towards_sun < 0.0L && off_axis2 < static_cast<long double>(kRadius_m) * kRadius_m;
}

// Hard case 15.
TEST(PlanetShadow, OfASegmentOfAThousandKilometresIsTheOneStretchThatAScanFinds) {
  // The shadow is convex: a ray that has left it stays in the light, whatever its direction.
  std::mt19937 random(15);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  constexpr int kSteps = 4000;
  constexpr double kLength_m = 1e6, kStep_m = kLength_m / kSteps;
  int lit_dark_lit = 0;
  for (int i = 0; i < 1000; ++i) {
    // Lowest in its middle, across the azimuth of a sun that stands 5 to 11 degrees below the
    // horizon there, more or less.
    ViewRay ray{60e3 + 60e3 * uniform(random), -0.09 + 0.03 * uniform(random),
                -std::sin((5.0 + 6.0 * uniform(random)) * kRadiansPerDegree), 0.0, kLength_m};
    ray.nu =
        ray.mu * ray.mu_s + 0.2 * (uniform(random) - 0.5) *
                                std::sqrt((1.0 - ray.mu * ray.mu) * (1.0 - ray.mu_s * ray.mu_s));
    const ShadowSpan shadow = PlanetShadow(ray, {0.0, kLength_m, RayEnd::kLength}, kRadius_m);
    int changes = 0;
    for (int k = 0; k <= kSteps; ++k) {
      const double t = k * kStep_m;
      const bool dark = IsDark(ray, t);
      changes += k > 0 && dark != IsDark(ray, t - kStep_m) ? 1 : 0;
      const double inside =
          std::min(t - shadow.dark_begin_m, shadow.dark_end_m - t);  // by how much
      if (std::abs(inside) <= 1e-3) continue;
      ASSERT_EQ(dark, inside > 0.0) << "ray " << i << " at " << t;
    }
    EXPECT_LE(changes, 2) << "ray " << i;
    lit_dark_lit +=
        shadow.dark_begin_m > 0.0 && shadow.dark_end_m < kLength_m && changes == 2 ? 1 : 0;
  }
  EXPECT_GT(lit_dark_lit, 100) << "of the rays go in and out again";
}

}  // namespace
}  // namespace alpenglow::atmosphere
