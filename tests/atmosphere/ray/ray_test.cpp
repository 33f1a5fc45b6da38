// SPDX-License-Identifier: MIT
// Geometry of rays in the shell is right where it is hard: on the ground, at the horizon, at the
// top and in space.
#include "atmosphere/ray/ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kRadius_m = 6.371e6;
constexpr double kTop_m = 120e3;

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

TEST(Ray, EndsAtItsLengthUnlessTheGroundIsNearer) {
  EXPECT_EQ(ExtentOf({100.0, 0.2, 1.0, 0.2, 5000.0}, kRadius_m, kTop_m).end, RayEnd::kLength);
  EXPECT_EQ(ExtentOf({100.0, -1.0, 1.0, -1.0, 5000.0}, kRadius_m, kTop_m).end, RayEnd::kGround);
  const auto passing = [](double length_m) {
    return ExtentOf({100.0, -1.0, 1.0, -1.0, length_m, true}, kRadius_m, kTop_m).end;
  };
  EXPECT_EQ(passing(5000.0), RayEnd::kLength);
  EXPECT_EQ(passing(13e3), RayEnd::kGround) << "no land is so deep";
  EXPECT_EQ(ExtentOf({100.0, 0.2, 1.0, 0.2, 0.0}, kRadius_m, kTop_m).end_m, 0.0);
}

// Hard case 2.
TEST(Ray, ASegmentBelowAltitudeZeroIsTheSameFromBothEnds) {
  // A chord from 50 m above to 400 m below altitude 0, and back.
  constexpr double kLength_m = 9000.0, kFrom_m = 50.0, kTo_m = -400.0;
  const double from = kRadius_m + kFrom_m, to = kRadius_m + kTo_m;
  const auto cosine = [](double at, double other) {
    return (other * other - at * at - kLength_m * kLength_m) / (2.0 * at * kLength_m);
  };
  const ViewRay down{kFrom_m, cosine(from, to), 1.0, 0.0, kLength_m, true};
  const ViewRay up{kTo_m, cosine(to, from), 1.0, 0.0, kLength_m};
  const auto part = [](const ViewRay& ray) {
    return SubmergedPart(ray, ExtentOf(ray, kRadius_m, kTop_m), kRadius_m);
  };
  EXPECT_NEAR(part(down).end_m, kLength_m, 1e-6);
  EXPECT_EQ(part(up).begin_m, 0.0);
  EXPECT_NEAR(part(down).end_m - part(down).begin_m, part(up).end_m, 1e-6);
  EXPECT_NEAR(part(down).mu_ground, part(up).mu_ground, 1e-9);
  ViewRay sky = down;
  sky.length_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(part(sky).Exists()) << "the ground ends it";
}

// Hard case 39.
TEST(Ray, ShortRaysEndAtGroundOrTopOnlyIfTheyReachThem) {
  constexpr double kFrom_m = 200.0;
  for (const double perigee_m : {-2.0, -0.5, 0.5, 2.0, 50.0}) {
    // The ray goes down to the perigee and up again.
    const double sine = (kRadius_m + perigee_m) / (kRadius_m + kFrom_m);
    const double mu = -std::sqrt((1.0 - sine) * (1.0 + sine));
    const double deepest_m = -(kRadius_m + kFrom_m) * mu;
    const ViewRay through{kFrom_m, mu, 1.0, 0.0, 1.5 * deepest_m, true};
    const RayExtent extent = ExtentOf(through, kRadius_m, kTop_m);
    EXPECT_EQ(extent.end, RayEnd::kLength) << perigee_m;
    EXPECT_EQ(extent.end_m, through.length_m);
    EXPECT_EQ(SubmergedPart(through, extent, kRadius_m).Exists(), perigee_m < 0.0) << perigee_m;
    ViewRay whole = through;
    whole.length_m = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ExtentOf(whole, kRadius_m, kTop_m).end == RayEnd::kGround, perigee_m < 0.0);
  }
  for (const double over_m : {-2.0, -0.5, 0.5, 2.0}) {
    const ViewRay up{kTop_m - 500.0, 1.0, 1.0, 1.0, 500.0 + over_m};
    EXPECT_EQ(ExtentOf(up, kRadius_m, kTop_m).end == RayEnd::kSpace, over_m > 0.0) << over_m;
  }
}

TEST(Spectrum, OperatorsWorkBandByBand) {
  Spectrum a(3, 2.0F), b(3);
  for (std::size_t band = 0; band < b.size(); ++band) b[band] = static_cast<float>(band);
  for (std::size_t band = 0; band < b.size(); ++band) {
    const auto of_b = static_cast<float>(band);
    EXPECT_EQ((a + b)[band], 2.0F + of_b);
    EXPECT_EQ((a * b)[band], 2.0F * of_b);
    EXPECT_EQ((0.5F * b)[band], 0.5F * of_b);
  }
  EXPECT_NE(a, b);
  EXPECT_NE(a, Spectrum(2, 2.0F));
  EXPECT_EQ(a, Spectrum(3, 2.0F));
}

TEST(Spectrum, BandsAndOperandsThatDoNotExistAreRefused) {
  const Spectrum three(3), four(4);
  EXPECT_THROW(static_cast<void>(three[3]), InputError);
  EXPECT_THROW(static_cast<void>(three + four), InputError);
  EXPECT_THROW(static_cast<void>(four * three), InputError);
}

TEST(Spectrum, TooManyAreRefused) {
  EXPECT_EQ(Spectrum(kMaxBands).size(), kMaxBands);
  EXPECT_THROW(Spectrum(kMaxBands + 1), InputError);
  EXPECT_THROW(SpectrumOf<double>(512), InputError);
}

TEST(PlanetShadow, EndsOnAZenithViewWhereTheSunRises) {
  // With the sun e below the horizon, the shadow reaches R (1 / cos e - 1) over the observer.
  for (const double e : {0.02, 0.07, 0.1, 0.14}) {
    const ViewRay ray{0.0, 1.0, -std::sin(e), -std::sin(e)};
    const ShadowSpan shadow = PlanetShadow(ray, ExtentOf(ray, kRadius_m, kTop_m), kRadius_m);
    EXPECT_EQ(shadow.dark_begin_m, 0.0);
    EXPECT_NEAR(shadow.dark_end_m, kRadius_m * (1.0 / std::cos(e) - 1.0), 1e-5) << "closed form";
  }
}

TEST(PlanetShadow, CoversAWholeRayAlongItsAxis) {
  const ViewRay ray{4e5, 1.0, -1.0, -1.0};
  const RayExtent extent{0.0, 1e6, RayEnd::kLength};
  const ShadowSpan shadow = PlanetShadow(ray, extent, kRadius_m);
  EXPECT_EQ(shadow.dark_begin_m, 0.0) << "behind the planet, away from the sun";
  EXPECT_EQ(shadow.dark_end_m, 1e6);
}

// Returns whether the planet hides a point of a ray from the sun, from the positions themselves.
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
TEST(PlanetShadow, OfALongSegmentAgreesWithAScan) {
  // The shadow is convex: a ray that has left it stays in the light, whatever its direction.
  std::mt19937 random(15);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  constexpr int kSteps = 4000;
  constexpr double kLength_m = 1e6, kStep_m = kLength_m / kSteps;
  int lit_dark_lit = 0;
  for (int i = 0; i < 1000; ++i) {
    // The ray is lowest in its middle, across the azimuth of a sun that stands 5 to 11 degrees
    // below the horizon there, more or less.
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

constexpr double kRadius_km = 6371.0;

double AltitudeOf(double h_km, double mu, double d_km) {
  const long double r = static_cast<long double>(kRadius_km) + h_km;
  const long double d = d_km;
  return static_cast<double>(std::sqrt(r * r + 2 * r * mu * d + d * d) - kRadius_km);
}

// Hard case 1.
TEST(Shell, TheHorizonFromTheGroundIsHorizontal) {
  EXPECT_EQ(shared::HorizonCosine(0.0, kRadius_km), 0.0);
  EXPECT_EQ(shared::HorizonCosine(0.0F, 6371.0F), 0.0F);
  EXPECT_EQ(shared::HorizonDistance(0.0, kRadius_km), 0.0);
}

// Hard case 9.
TEST(Shell, AltitudeAlongARayEqualsThePlainFormula) {
  for (const double h : {0.0, 1e-5, 0.002, 1.0, 10.0, 120.0, 400.0}) {
    for (const double mu : {-1.0, -0.3, -0.01, 0.0, 0.01, 0.5, 1.0}) {
      for (const double d : {1e-6, 0.1, 10.0, 500.0}) {
        EXPECT_NEAR(shared::AltitudeAlongRay(h, mu, d, kRadius_km), AltitudeOf(h, mu, d), 1e-11)
            << "10 nm: rounding of doubles the size of the planet is cancelled by the formula";
      }
    }
  }
}

TEST(Shell, DistancesReachTheRequestedAltitude) {
  for (const double h : {0.0, 0.002, 1.0, 60.0, 120.0, 400.0}) {
    for (const double mu : {-1.0, -0.5, -0.05, -1e-4, 0.0, 1e-4, 0.3, 1.0}) {
      for (const double z : {0.0, 0.01, 10.0, 60.0, 120.0, 400.0}) {
        if (z >= h) {
          const double d = shared::DistanceUpTo(h, mu, z, kRadius_km);
          EXPECT_GE(d, 0.0);
          EXPECT_NEAR(AltitudeOf(h, mu, d), z, 1e-9) << h << " " << mu << " " << z;
        } else if (mu < 0.0 && shared::PerigeeAltitude(h, mu, kRadius_km) < z) {
          const double d = shared::DistanceDownTo(h, mu, z, kRadius_km);
          EXPECT_GT(d, 0.0);
          EXPECT_NEAR(AltitudeOf(h, mu, d), z, 1e-9) << h << " " << mu << " " << z;
        }
      }
    }
  }
}

TEST(Shell, LowestPointOfALineIsItsPerigee) {
  for (const double h : {0.002, 1.0, 60.0, 400.0}) {
    for (const double mu : {-0.3, -0.05, -1e-4, 0.0}) {
      const double perigee = shared::PerigeeAltitude(h, mu, kRadius_km);
      const double at = -(kRadius_km + h) * mu;
      EXPECT_NEAR(AltitudeOf(h, mu, at), perigee, 1e-9);
      EXPECT_GE(AltitudeOf(h, mu, at + 1.0), perigee);
      EXPECT_GE(AltitudeOf(h, mu, at - 1.0), perigee);
    }
  }
}

// Hard case 7.
TEST(Shell, HorizonIsTheRayThatGrazesTheGround) {
  for (const double h : {1e-5, 0.002, 1.0, 11.0, 60.0, 400.0, 35786.0}) {
    const double mu = shared::HorizonCosine(h, kRadius_km);
    EXPECT_NEAR(shared::PerigeeAltitude(h, mu, kRadius_km), 0.0, 1e-11 * (kRadius_km + h))
        << "rounding of mu moves the perigee by r mu times 1e-16";
    EXPECT_LT(shared::GroundClearance(h, mu + 1e-9, kRadius_km), 0.0);
    EXPECT_GT(shared::GroundClearance(h, mu - 1e-9, kRadius_km), 0.0);
  }
}

// Hard case 7.
TEST(Shell, FloatSeparatesGroundFromSkyToAMillimetre) {
  for (const float h : {1e-5F, 0.002F, 0.1F, 1.0F, 11.0F}) {
    const float horizon = shared::HorizonCosine(h, 6371.0F);
    for (int step = -40; step <= 40; ++step) {
      const float mu = horizon * (1.0F + 1e-5F * static_cast<float>(step));
      const bool hits = shared::GroundClearance(h, mu, 6371.0F) > 0.0F;
      const double exact = shared::PerigeeAltitude<double>(static_cast<double>(h),
                                                           static_cast<double>(mu), kRadius_km);
      if (std::abs(exact) > 2e-7 * static_cast<double>(h) + 1e-12) {
        EXPECT_EQ(hits, exact < 0.0) << h << " " << mu << " perigee " << exact;
      }
    }
  }
}

// Hard case 1.
TEST(Extent, HorizontalRaysAtAltitudeZeroLeaveTheAir) {
  const RayExtent extent = ExtentOf({0.0, 0.0}, kRadius_m, kTop_m);
  EXPECT_EQ(extent.end, RayEnd::kSpace);
  EXPECT_EQ(extent.begin_m, 0.0);
  EXPECT_NEAR(extent.end_m, std::sqrt(kTop_m * (2.0 * kRadius_m + kTop_m)), 1e-6);
}

// Hard case 1.
TEST(Extent, DownwardRaysOnTheGroundHitItAtOnce) {
  const double barely_down = std::nextafter(0.0, -1.0);
  for (const double mu : {barely_down, -1e-12, -0.5, -1.0}) {
    const RayExtent extent = ExtentOf({0.0, mu}, kRadius_m, kTop_m);
    EXPECT_EQ(extent.end, RayEnd::kGround) << mu;
    EXPECT_EQ(extent.end_m, 0.0) << mu;
  }
}

// Hard case 2.
TEST(Extent, ObserversBelowTheSphereSeeTheSkyOfTheGround) {
  for (const double altitude_m : {-430.0, -11000.0}) {
    for (const double mu : {0.0, 0.1, 1.0}) {
      const RayExtent below = ExtentOf({altitude_m, mu}, kRadius_m, kTop_m);
      const RayExtent ground = ExtentOf({0.0, mu}, kRadius_m, kTop_m);
      EXPECT_EQ(below.end_m, ground.end_m);
      EXPECT_EQ(below.end, RayEnd::kSpace);
    }
  }
}

// Hard case 3.
TEST(Extent, RefusesNonFiniteRaysAndNamesTheField) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::pair<ViewRay, const char*> rays[] = {
      {{kNan, 1.0}, "altitude_m"},
      {{kInfinity, 1.0}, "altitude_m"},
      {{-kRadius_m, 1.0}, "altitude_m"},  // the centre of the planet
      {{-2.0 * kRadius_m, 1.0}, "altitude_m"},
      {{0.0, kNan}, "mu "},
      {{0.0, 1.0, kNan}, "mu_s"},
      {{0.0, 1.0, 1.0, kNan}, "nu"},
      {{0.0, 1.0, 1.0, 1.0, kNan}, "length_m"},
      {{0.0, 0.0, 1.0, 0.0, -1.0}, "length_m"}};
  for (const auto& bad : rays) {
    const std::string fault =
        tests::FaultOf([&] { return ExtentOf(bad.first, kRadius_m, kTop_m); });
    EXPECT_NE(fault.find(bad.second), std::string::npos) << fault;
  }
}

// Hard case 4.
TEST(Extent, IsContinuousThroughTheTop) {
  for (const double mu : {-1.0, -0.5, -0.19}) {
    const double below = ExtentOf({kTop_m - 1e-6, mu}, kRadius_m, kTop_m).end_m;
    const RayExtent above = ExtentOf({kTop_m + 1e-6, mu}, kRadius_m, kTop_m);
    EXPECT_NEAR(above.end_m - above.begin_m, below, 1e-4) << "2 um of altitude, over |mu| > 0.02";
  }
  for (const double mu : {0.0, 1e-9, 0.5, 1.0}) {
    const RayExtent above = ExtentOf({kTop_m + 1e-6, mu}, kRadius_m, kTop_m);
    EXPECT_EQ(above.begin_m, above.end_m) << "upwards from above the top there is no air";
  }
}

// Hard case 8.
TEST(Extent, RaysGrazingTheTopFromOutsideHaveZeroLength) {
  for (const double altitude_m : {400e3, 35786e3, 1e8}) {
    const double r = kRadius_m + altitude_m;
    const double r_top = kRadius_m + kTop_m;
    const double grazing = -std::sqrt((r - r_top) * (r + r_top)) / r;
    double mu = grazing;
    for (int i = 0; i < 8; ++i) mu = std::nextafter(mu, -1.0);
    for (int i = 0; i < 16; ++i, mu = std::nextafter(mu, 1.0)) {
      const RayExtent extent = ExtentOf({altitude_m, mu}, kRadius_m, kTop_m);
      const double length = extent.end_m - extent.begin_m;
      EXPECT_GE(length, 0.0);
      EXPECT_LT(length, 2e4 * std::sqrt(r / kRadius_m))
          << "one ulp of mu lowers the grazing point by r mu 1e-16, a chord of sqrt(8 R times "
             "that)";
    }
    const RayExtent missed = ExtentOf({altitude_m, grazing + 1e-9}, kRadius_m, kTop_m);
    EXPECT_EQ(missed.begin_m, missed.end_m);
  }
}

// Hard case 5.
TEST(Extent, RaysAtTheLimbEnterAndLeaveSymmetrically) {
  for (const double altitude_m : {400e3, 35786e3, 1e8}) {
    const double r = kRadius_m + altitude_m;
    const double tangent = kRadius_m + 30e3;
    const double mu = -std::sqrt((r - tangent) * (r + tangent)) / r;
    const RayExtent extent = ExtentOf({altitude_m, mu}, kRadius_m, kTop_m);
    EXPECT_EQ(extent.end, RayEnd::kSpace);
    const double middle = 0.5 * (extent.begin_m + extent.end_m);
    EXPECT_NEAR(middle, -r * mu, 1e-6 * r / kRadius_m);
    EXPECT_NEAR(extent.end_m - extent.begin_m, 2.0 * std::sqrt(90e3 * (2.0 * kRadius_m + 150e3)),
                0.1)
        << "rounding of mu moves the tangent by 1e-8 m, and the chord by ten times that";
    EXPECT_GT(extent.begin_m, 0.0);
    const RayExtent down = ExtentOf({altitude_m, -1.0, 1.0, -1.0}, kRadius_m, kTop_m);
    EXPECT_EQ(down.end, RayEnd::kGround);
    EXPECT_NEAR(down.begin_m, altitude_m - kTop_m, 1e-6);
    EXPECT_NEAR(down.end_m, altitude_m, 1e-6);
  }
}

// Hard case 7.
TEST(Extent, RaysEndAtTheGroundBelowTheHorizonElseInSpace) {
  for (const double altitude_m : {0.01, 1.7, 1000.0, 11000.0, 400e3}) {
    const double horizon = shared::HorizonCosine(altitude_m * 1e-3, kRadius_km);
    const RayExtent over = ExtentOf({altitude_m, horizon + 1e-14}, kRadius_m, kTop_m);
    const RayExtent under = ExtentOf({altitude_m, horizon - 1e-14}, kRadius_m, kTop_m);
    EXPECT_EQ(over.end, RayEnd::kSpace) << altitude_m;
    EXPECT_EQ(under.end, RayEnd::kGround) << altitude_m;
    const double to_horizon = shared::HorizonDistance(altitude_m * 1e-3, kRadius_km) * 1e3;
    EXPECT_NEAR(under.end_m, to_horizon, 1.0 + 1e-4 * to_horizon)
        << "near grazing the hit moves with the root of the step";
  }
}

// Hard case 10.
TEST(Extent, VerticalViewsDoNotDependOnAzimuth) {
  for (const double zenith : {0.0, 180.0}) {
    const ViewRay north = RayFromAngles(2.0, zenith, 0.0, 40.0);
    for (const double azimuth : {90.0, 180.0, 271.0}) {
      EXPECT_NEAR(RayFromAngles(2.0, zenith, azimuth, 40.0).nu, north.nu, 1e-15);
    }
  }
}

TEST(PlanetShadow, LiesOnlyBehindThePlanet) {
  const ViewRay noon = RayFromAngles(2.0, 45.0, 0.0, 30.0);
  const ShadowSpan none = PlanetShadow(noon, ExtentOf(noon, kRadius_m, kTop_m), kRadius_m);
  EXPECT_EQ(none.dark_begin_m, none.dark_end_m);
  const ViewRay midnight = RayFromAngles(2.0, 45.0, 0.0, 180.0);
  const RayExtent extent = ExtentOf(midnight, kRadius_m, kTop_m);
  const ShadowSpan all = PlanetShadow(midnight, extent, kRadius_m);
  EXPECT_EQ(all.dark_begin_m, extent.begin_m);
  EXPECT_EQ(all.dark_end_m, extent.end_m);
}

}  // namespace
}  // namespace alpenglow::atmosphere
