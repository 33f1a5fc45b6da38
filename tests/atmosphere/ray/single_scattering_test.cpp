// SPDX-License-Identifier: MIT
#include "atmosphere/ray/single_scattering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/reference/reference_solution.h"
#include "tests/fixtures/bands_near.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/ray_regimes.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere {
namespace {

template <typename Real>
SpectrumOf<Real> Inscatter(const SingleScattering<Real>& air, const ViewRay& ray,
                           const Sampling& sampling) {
  return air.Inscatter(air.Scatter(air.Sample(ray, sampling)), ray.nu);
}

// An observer near the ground looks along these rays.
std::vector<ViewRay> RaysUnderSun(double sun_elevation_deg) {
  std::vector<ViewRay> rays;
  for (const double altitude : {2.0, 1500.0, 10000.0}) {
    for (const double view : {5.0, 70.0, 89.0}) {
      for (const double azimuth : {60.0, 180.0}) {
        rays.push_back(RayFromAngles(altitude, view, azimuth, 90.0 - sun_elevation_deg));
      }
    }
  }
  return rays;
}

double LargestErrorUnderSun(double sun_elevation_deg, const Sampling& sampling) {
  const Medium medium = MediumPreset("bruneton2017");
  const SingleScattering<float> air(medium);
  double largest = 0.0;
  for (const ViewRay& ray : RaysUnderSun(sun_elevation_deg)) {
    const auto fast = Inscatter(air, ray, sampling);
    const auto truth = reference::SingleScatteringAlong(medium, ray);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      if (truth.inscatter[band] < 1e-12) continue;
      largest = std::max(largest,
                         std::abs(static_cast<double>(fast[band]) / truth.inscatter[band] - 1.0));
    }
  }
  return largest;
}

constexpr Sampling kFine{.nodes = 16, .split_ozone = true, .dark_samples = false};

TEST(SingleScattering, DaySunsetAndTwilightAgreeWithTheReference) {
  constexpr std::array kSuns_deg{60.0, 4.0, 0.0, -1.0, -6.0};
  for (const double sun : std::span(kSuns_deg).last(tests::ScaledDown<std::size_t>(5, 2))) {
    EXPECT_LT(LargestErrorUnderSun(sun, kFine), 1e-4)
        << "sun at " << sun << " degrees; 16 nodes a panel, tent split";
  }
}

TEST(SingleScattering, AgreesWithStoredCasesToOnePartInTenThousand) {
  const auto media = stored::Media();
  const auto is_no_limb_ray = [&](const stored::Row& row) {
    const ViewRay ray = stored::RayOf(row);
    const Medium& medium = media.at(row.at("set"));
    return ray.mu >= 0.0 ||
           ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m).end != RayEnd::kSpace;
  };
  const int compared =
      stored::Compare("single", is_no_limb_ray, [](const stored::Row& row, const Medium& medium) {
        const auto fast = Inscatter(SingleScattering<float>(medium), stored::RayOf(row), kFine);
        return [fast, &row](const stored::Row& expected, std::size_t band) {
          const double truth = stored::Number(expected, "inscatter");
          EXPECT_NEAR(static_cast<double>(fast[band]), truth, 1e-4 * truth + 1e-13)
              << row.at("id") << " " << row.at("tag");
        };
      });
  EXPECT_GT(compared, 300);
}

/// A segment by the altitudes of its ends, and the same segment from its other end.
struct BothWays {
  ViewRay there, back;
};
BothWays SegmentBetween(double from_m, double to_m, double length_m, double radius_m,
                        double sun_zenith_deg) {
  const auto cosine = [length_m](double at, double other) {
    return ((other - at) * (other + at) - length_m * length_m) / (2.0 * at * length_m);
  };
  const double mu = cosine(radius_m + from_m, radius_m + to_m);
  const double mu_s = std::cos(sun_zenith_deg * kRadiansPerDegree);
  const double nu = mu * mu_s + 0.5 * std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s));
  const double back_mu = cosine(radius_m + to_m, radius_m + from_m);
  const double back_mu_s = ((radius_m + from_m) * mu_s + length_m * nu) / (radius_m + to_m);
  return {{from_m, mu, mu_s, nu, length_m, true}, {to_m, back_mu, back_mu_s, -nu, length_m, true}};
}

struct SegmentEnds {
  double from_m, to_m, length_m;
};
constexpr std::array kSegmentsBelow{
    SegmentEnds{-400.0, -430.0, 10e3}, SegmentEnds{-430.0, -400.0, 10e3},
    SegmentEnds{100.0, -430.0, 10e3},  SegmentEnds{0.0, 0.0, 10e3},
    SegmentEnds{2.0, 2.0, 60e3},       SegmentEnds{3000.0, -10e3, 40e3},
    SegmentEnds{-8000.0, 20e3, 90e3},  SegmentEnds{20.0, -1.0, 300.0},
    SegmentEnds{400e3, -430.0, 900e3}, SegmentEnds{60e3, 50e3, 1050e3}};

// Hard case 2.
TEST(SingleScattering, AirContinuesBelowAltitudeZeroInBothDirections) {
  for (const char* preset : {"earth", "bruneton2017", "mars"}) {
    const Medium medium = MediumPreset(preset);
    const SingleScattering<double> exact(medium);
    const SingleScattering<float> quick(medium);
    for (const SegmentEnds& ends : kSegmentsBelow) {
      SCOPED_TRACE(::testing::Message() << preset << ", " << ends.from_m << " m to " << ends.to_m);
      const auto [there, back] =
          SegmentBetween(ends.from_m, ends.to_m, ends.length_m, medium.planet_radius_m, 60.0);
      const auto depth = exact.OpticalDepthAlong(there), other = exact.OpticalDepthAlong(back);
      const auto in_float = quick.OpticalDepthAlong(there);
      const auto truth = reference::OpticalDepthAlong(medium, there);
      for (std::size_t band = 0; band < depth.size(); ++band) {
        EXPECT_NEAR(depth[band], truth.tau[band], 2e-5 * truth.tau[band]) << "closed forms";
        EXPECT_NEAR(depth[band], other[band], 2e-5 * depth[band]);
        EXPECT_NEAR(static_cast<double>(in_float[band]), truth.tau[band], 1e-4 * truth.tau[band]);
      }
    }
  }
}

TEST(SingleScattering, BelowAltitudeZeroDepthIsLengthTimesExtinction) {
  const Medium medium = MediumPreset("bruneton2017");
  const BothWays ways = SegmentBetween(-400.0, -430.0, 10e3, medium.planet_radius_m, 60.0);
  for (const ViewRay& ray : {ways.there, ways.back}) {
    const auto depth = SingleScattering<double>(medium).OpticalDepthAlong(ray);
    for (std::size_t band = 0; band < depth.size(); ++band) {
      EXPECT_NEAR(
          depth[band],
          10e3 * (medium.rayleigh_scattering_per_m[band] + medium.mie_extinction_per_m[band]),
          1e-9);
    }
  }
}

// Hard case 2.
TEST(SingleScattering, LightBelowAltitudeZeroAgreesWithTheReference) {
  const Medium medium = MediumPreset("bruneton2017");
  for (const double sun_zenith_deg : {60.0, 88.0, 93.0}) {
    for (const SegmentEnds& ends : std::span(kSegmentsBelow).first(tests::ScaledDown(8U, 3U))) {
      SCOPED_TRACE(::testing::Message()
                   << ends.from_m << " m to " << ends.to_m << ", sun " << sun_zenith_deg);
      const auto ways = SegmentBetween(ends.from_m, ends.to_m, ends.length_m,
                                       medium.planet_radius_m, sun_zenith_deg);
      for (const ViewRay& ray : {ways.there, ways.back}) {
        const auto truth = reference::SingleScatteringAlong(medium, ray).inscatter;
        const auto found = Inscatter(SingleScattering<double>(medium), ray, kFine);
        for (std::size_t band = 0; band < found.size(); ++band)
          EXPECT_NEAR(found[band], truth[band], 1e-3 * truth[band] + 1e-12);
      }
    }
  }
}

double ErrorOf(const Medium& medium, const tests::SunHeights& sun, tests::RayView view,
               const Sampling& sampling) {
  return tests::ErrorOfRegime(medium, sun, view, sampling, 200).rms;
}

TEST(SingleScattering, EightSamplesKeepAThousandthAndTwelveATenThousandth) {
  const Medium medium = MediumPreset("earth");
  for (const auto& sun : tests::kSunHeights) {
    for (const auto& view : tests::kRayViews) {
      SCOPED_TRACE(::testing::Message() << "sun " << sun.name << ", " << view.name);
      EXPECT_LT(ErrorOf(medium, sun, view.view, {.nodes = 8}), 1e-3) << "rms";
      EXPECT_LT(ErrorOf(medium, sun, view.view, {.nodes = 12}), 1e-4) << "rms";
    }
  }
}

TEST(SingleScattering, HazeNeedsNoMoreNodesThanTheEarthsAir) {
  const Medium medium = MediumPreset("hazy");
  for (const auto& [error, nodes] :
       {std::pair{1e-2, 6}, std::pair{1e-3, 8}, std::pair{1e-4, 12}, std::pair{1e-5, 16}}) {
    const Sampling sampling{.nodes = nodes, .split_ozone = error < 5e-3};
    for (const auto& sun : tests::kSunHeights) {
      for (const auto& view : tests::kRayViews)
        EXPECT_LT(ErrorOf(medium, sun, view.view, sampling), error)
            << nodes << " nodes, sun " << sun.name << ", " << view.name;
    }
  }
}

TEST(SingleScattering, A100MetreLayerIsSampledAsWellAsTheEarthsAir) {
  Medium medium = tests::MoleculesOf(MediumPreset("bruneton2017"));
  medium.atmosphere_height_m = 2500.0;
  medium.rayleigh_scale_height_m = 100.0;
  medium.rayleigh_scattering_per_m.assign(3, 0.1 / 100.0);
  const SingleScattering<double> air(medium);
  for (const double zenith_deg : {10.0, 60.0, 82.0, 94.0, 130.0}) {
    for (const double sun_deg : {20.0, 78.0, 88.0}) {
      const ViewRay ray =
          RayFromAngles(zenith_deg > 90.0 ? 2500.0 : 0.0, zenith_deg, 90.0, sun_deg);
      // 1e-5 was found over 135 rays.
      EXPECT_NEAR(Inscatter(air, ray, {.nodes = 12})[0] / Inscatter(air, ray, {.nodes = 32})[0],
                  1.0, 1e-4)
          << zenith_deg << " " << sun_deg;
    }
  }
}

// Rays through twilight have up to 912 samples where ozone is a tent and samples in shadow count.
TEST(SingleScattering, FinestSamplingFitsForEveryKindOfRay) {
  const Medium medium = MediumPreset("bruneton2017");
  const SingleScattering<double> air(medium);
  const Sampling finest{.nodes = 32, .split_ozone = true, .dark_samples = true};
  std::size_t most = 0;
  for (const double altitude_m : {10.0, 12e3, 30e3, 59e3, 400e3}) {
    const double ratio = medium.planet_radius_m / (medium.planet_radius_m + altitude_m);
    const double horizon = -std::sqrt(1.0 - ratio * ratio);
    for (int i = 0; i < 40; ++i) {
      const double mu = horizon + 0.05 * std::pow((i + 0.5) / 40.0, 3.0);
      for (const double mu_s : {-0.3, -0.2, -0.15, -0.1, -0.07, -0.04, -0.01}) {
        for (const double side : {-1.0, -0.7, 0.7, 1.0}) {
          const double nu = mu * mu_s + side * std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s));
          const auto samples = air.Sample({altitude_m, mu, mu_s, nu}, finest);
          most = std::max(most, samples.count);
        }
      }
    }
  }
  EXPECT_GT(most, 592U) << "the rays must be those that need the room";
  EXPECT_LE(most, kMaxRaySamples - 16);
}

// This shows that the truth of ErrorOfRegime is right.
TEST(SingleScattering, SixtyFourSamplesEqualTheReferenceInEveryRegime) {
  const Medium medium = MediumPreset("hazy");
  const SingleScattering<double> air(medium);
  for (const auto& sun : tests::kSunHeights) {
    for (const auto& view : tests::kRayViews) {
      for (int i = 1; i <= tests::ScaledDown(3, 1); ++i) {
        const ViewRay ray = tests::RayOfRegime(i, sun, view.view, medium);
        const auto truth = reference::SingleScatteringAlong(medium, ray);
        const auto fine = Inscatter(air, ray, {.nodes = 64});
        EXPECT_TRUE(tests::BandsNear(fine, truth.inscatter, 2e-6, 1e-14))
            << "sun " << sun.name << ", " << view.name << ": the closed form of the columns";
      }
    }
  }
}

// Hard case 9.
TEST(SingleScattering, FloatAgreesWithDouble) {
  const Medium medium = MediumPreset("earth");
  const SingleScattering<float> single(medium);
  const SingleScattering<double> twice(medium);
  for (const double sun : {60.0, 6.0, 1.0, -3.0}) {
    for (const ViewRay& ray : RaysUnderSun(sun)) {
      EXPECT_TRUE(tests::BandsNear(Inscatter(single, ray, kFine), Inscatter(twice, ray, kFine),
                                   2e-5, 1e-13))
          << "float floor of the pipeline: exp of optical depths up to 30 in float";
    }
  }
}

// Hard case 14.
TEST(SingleScattering, SegmentsOfLengthZeroAreExactlyZero) {
  const SingleScattering<float> air(MediumPreset("earth"));
  const std::vector<float> nothing(air.bands(), 0.0F), all(air.bands(), 1.0F);
  for (const double mu : {1.0, 0.1, 0.0, -0.01, -1.0}) {
    const ViewRay ray{100.0, mu, 0.5, 0.3, 0.0};
    const auto scattered = air.Scatter(air.Sample(ray, {}));
    EXPECT_TRUE(tests::BandsNear(scattered.rayleigh, nothing, 0.0));
    EXPECT_TRUE(tests::BandsNear(scattered.mie, nothing, 0.0));
    EXPECT_TRUE(tests::BandsNear(air.TransmittanceAlong(ray), all, 0.0));
  }
}

TEST(SingleScattering, ShortSegmentsKeepTheirOpticalDepth) {
  // The difference of two closed forms would have no right digit here; the integral has.
  const Medium medium = MediumPreset("bruneton2017");
  const SingleScattering<double> air(medium);
  for (const double length : {1.0, 100.0, 10000.0}) {
    const ViewRay ray{500.0, 0.05, 0.5, 0.3, length};
    const auto truth = reference::OpticalDepthAlong(medium, ray);
    const auto fast = air.TransmittanceAlong(ray);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      EXPECT_NEAR(-std::log(fast[band]) / truth.tau[band], 1.0, 1e-5) << length << " m";
    }
  }
}

TEST(SingleScattering, ColumnsBetweenSamplesSumToThatOfTheRay) {
  const Medium medium = MediumPreset("earth");
  const SingleScattering<double> air(medium);
  const auto columns_between = [&](const ViewRay& ray, std::size_t steps) {
    std::vector<RayNode> nodes;
    for (std::size_t i = 1; i <= steps; ++i) {
      nodes.push_back({ray.length_m * static_cast<double>(i) / static_cast<double>(steps), 0.0});
    }
    const RayExtent extent{0.0, ray.length_m, RayEnd::kLength};
    const auto samples = air.SampleAt(ray, extent, {}, nodes, ViewColumns::kBetweenSamples);
    return std::array<double, 2>{samples.view_rayleigh[steps - 1], samples.view_mie[steps - 1]};
  };
  for (const double mu : {-0.12, -0.02, 0.0, 0.03, 0.11}) {
    const ViewRay ray{5000.0, mu, 0.4, 0.3, 40e3};
    const double rise_m = std::abs(
        shared::AltitudeAlongRay<double>(5000.0, mu, ray.length_m, medium.planet_radius_m) -
        5000.0);
    const auto truth = columns_between(ray, 200);
    for (const std::size_t steps : {1U, 2U, 3U, 6U}) {
      const auto found = columns_between(ray, steps);
      const auto bound = [&](double scale_height_m) {
        return 6e-10 * std::pow(rise_m / scale_height_m / static_cast<double>(steps), 8.0) + 1e-8;
      };
      EXPECT_NEAR(found[0] / truth[0], 1.0, bound(medium.rayleigh_scale_height_m))
          << mu << ": 4 Gauss nodes; 1e-8: the altitude without a square root";
      EXPECT_NEAR(found[1] / truth[1], 1.0, bound(medium.mie_scale_height_m)) << mu;
    }
    const auto whole = air.OpticalDepthAlong(ray);
    const auto& per_km = air.constants();
    const auto samples = air.SampleAt(ray, {0.0, ray.length_m, RayEnd::kLength}, {},
                                      std::array{RayNode{20e3, 0.0}, RayNode{40e3, 0.0}},
                                      ViewColumns::kBetweenSamples);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      const double depth = per_km.rayleigh[band] * samples.view_rayleigh[1] +
                           per_km.mie_extinction[band] * samples.view_mie[1] +
                           per_km.ozone[band] * samples.view_ozone[1];
      EXPECT_NEAR(depth / whole[band], 1.0, 2e-5)
          << mu << ": the closed form is right to 3e-6 of the column to space";
    }
  }
}

TEST(SingleScattering, TransmittanceAgreesWithTheReferenceAtEveryAngle) {
  const Medium medium = MediumPreset("earth");
  const SingleScattering<float> air(medium);
  for (const double altitude : {0.0, 10.0, 3000.0, 30000.0, 80000.0}) {
    for (double mu = -0.3; mu <= 1.0; mu += 0.01) {
      const auto truth = reference::OpticalDepthAlong(medium, {altitude, mu, 1.0, mu});
      const auto fast = air.TransmittanceToSpace(altitude, mu);
      for (std::size_t band = 0; band < air.bands(); ++band) {
        const double expected = truth.blocked ? 0.0 : std::exp(-truth.tau[band]);
        EXPECT_NEAR(static_cast<double>(fast[band]), expected, 1e-5) << altitude << " m, mu " << mu;
      }
    }
  }
}

// Hard case 10.
TEST(SingleScattering, ZenithAndNadirViewsDoNotDependOnAzimuth) {
  const SingleScattering<float> air(MediumPreset("earth"));
  for (const double view : {0.0, 180.0}) {
    const auto one = Inscatter(air, RayFromAngles(5000.0, view, 0.0, 50.0), kFine);
    const auto other = Inscatter(air, RayFromAngles(5000.0, view, 137.0, 50.0), kFine);
    EXPECT_TRUE(tests::BandsNear(other, one, 1e-6));
  }
}

// Hard case 4.
TEST(SingleScattering, LightIsContinuousAtTheTopOfTheAtmosphere) {
  const Medium medium = MediumPreset("earth");
  const SingleScattering<float> air(medium);
  const double top = medium.atmosphere_height_m;
  for (const double view : {95.0, 100.0, 120.0, 180.0}) {
    const auto below = Inscatter(air, RayFromAngles(top - 1e-6, view, 40.0, 60.0), kFine);
    const auto above = Inscatter(air, RayFromAngles(top + 1e-6, view, 40.0, 60.0), kFine);
    EXPECT_TRUE(tests::BandsNear(above, below, 1e-4)) << view;
  }
}

TEST(SingleScattering, AMarchOfManyStepsGivesTheSameLight) {
  const SingleScattering<float> air(MediumPreset("bruneton2017"));
  for (const double sun_elevation_deg : {30.0, -3.0}) {
    const ViewRay ray = RayFromAngles(1500.0, 80.0, 20.0, 90.0 - sun_elevation_deg);
    const RayExtent extent = air.Sample(ray, kFine).extent;
    constexpr int kSteps = 512;
    const double step = (extent.end_m - extent.begin_m) / kSteps;
    std::vector<RayNode> nodes;
    for (int i = 0; i < kSteps; ++i) nodes.push_back({extent.begin_m + (i + 0.5) * step, step});
    const auto march = air.Inscatter(air.Scatter(air.SampleAt(ray, nodes)), ray.nu);
    const auto gauss = Inscatter(air, ray, kFine);
    // The step that holds the edge of the planet's shadow is lit or not as a whole: 1 / kSteps of
    // the ray, in thin air.
    EXPECT_TRUE(tests::BandsNear(march, gauss, 2e-3)) << sun_elevation_deg;
  }
}

TEST(SingleScattering, TooManyWavelengthsAreRefused) {
  std::vector<double> wavelengths_nm;
  for (std::size_t i = 0; i <= kMaxBands; ++i)
    wavelengths_nm.push_back(400.0 + static_cast<double>(i));
  EXPECT_THROW(SingleScattering<float>{MediumPreset("earth", wavelengths_nm)}, InputError);
}

// Dust of the desert has a table at every wavelength.
Medium Dusty() { return MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "dusty"); }

TEST(SingleScattering, EveryBandHasItsOwnPhaseFunction) {
  const Medium medium = Dusty();
  const SingleScattering<float> air(medium);
  for (const ViewRay& ray : RaysUnderSun(20.0)) {
    const auto light = Inscatter(air, ray, kFine);
    EXPECT_TRUE(
        tests::BandsNear(light, reference::SingleScatteringAlong(medium, ray).inscatter, 1e-4))
        << "16 nodes a panel";
    for (std::size_t band = 0; band < air.bands(); ++band) {
      Medium shared = medium;
      shared.mie_phase = {medium.mie_phase[band]};
      EXPECT_EQ(light[band], Inscatter(SingleScattering<float>(shared), ray, kFine)[band]);
    }
  }
}

// Dust has a peak a degree wide, continental air a wider one.
TEST(SingleScattering, PhaseFunctionsInFloatEqualTheirTables) {
  for (const Medium& medium : {Dusty(), MediumPreset("mars"), MediumPreset("earth")}) {
    const SingleScattering<float> fast(medium);
    const SingleScattering<double> exact(medium);
    for (int i = 0; i <= 3600; ++i) {
      const double share = i / 3600.0;  // more about the sun
      const double nu = std::cos(kPi * share * share);
      const Spectrum read = fast.AerosolPhases(nu);
      const SpectrumOf<double> held = exact.AerosolPhases(nu);
      for (std::size_t band = 0; band < held.size(); ++band) {
        ASSERT_EQ(held[band], Phase(MiePhase(medium, band), nu));
        ASSERT_NEAR(static_cast<double>(read[band]) / held[band], 1.0, 3e-5)
            << "places among nodes in float; at " << 180.0 * share * share << " degrees";
      }
    }
  }
}

// Hard case 12.
TEST(SingleScattering, SharpPhaseFunctionsAreFiniteTowardsTheSun) {
  Medium medium = MediumPreset("earth");
  for (const double g : {0.999, -0.999}) {
    medium.mie_phase = {tests::LobeOf(g)};
    const SingleScattering<float> air(medium);
    for (const double nu : {1.0, -1.0}) {
      const auto light = Inscatter(air, {2.0, nu * 0.5, 0.5, nu}, kFine);
      for (std::size_t band = 0; band < air.bands(); ++band)
        EXPECT_TRUE(std::isfinite(light[band]) && light[band] > 0.0F) << g << " " << nu;
    }
  }
}

// A level segment of 1000 km, 60 km up in its middle, across the azimuth of a sun so far below the
// horizon that the axis of the planet's shadow passes `depth_m` further than its edge: for depths
// over 0 the segment goes from light into shadow and into light again.
ViewRay ThroughTheShadow(const Medium& medium, double depth_m) {
  constexpr double kHalf_m = 500e3, kMiddle_m = 60e3;
  const double middle_r = medium.planet_radius_m + kMiddle_m;
  const double sine =
      std::sqrt((kMiddle_m + depth_m) * (2.0 * medium.planet_radius_m + kMiddle_m - depth_m)) /
      middle_r;  // of the sun's depression
  const double r = std::hypot(middle_r, kHalf_m);
  const double altitude_m = kMiddle_m + kHalf_m * kHalf_m / (r + middle_r);
  return {altitude_m, -kHalf_m / r, -sine * middle_r / r, 0.0, 2.0 * kHalf_m};
}

// Hard case 15.
TEST(SingleScattering, SegmentsThroughThePlanetsShadowHaveNoSeam) {
  const Medium medium = MediumPreset("earth");
  const SingleScattering<float> air(medium);
  for (const double depth_m : {-20e3, -100.0, -1.0, 1.0, 100.0, 3e3, 10e3, 18e3}) {
    const ViewRay ray = ThroughTheShadow(medium, depth_m);
    const ShadowSpan shadow =
        PlanetShadow(ray, {0.0, ray.length_m, RayEnd::kLength}, medium.planet_radius_m);
    const double dark_m = shadow.dark_end_m - shadow.dark_begin_m;
    EXPECT_NEAR(dark_m,
                2.0 * std::sqrt(std::max(depth_m, 0.0) * (2.0 * medium.planet_radius_m - depth_m)),
                1.0)
        << "the chord through a cylinder";
    EXPECT_TRUE(tests::BandsNear(Inscatter(air, ray, kFine),
                                 reference::SingleScatteringAlong(medium, ray).inscatter, 2e-4))
        << depth_m << " m: 16 nodes a panel";
  }
}

// Hard case 15.
TEST(SingleScattering, LightIsContinuousWhereAShadowEnds) {
  const Medium medium = MediumPreset("earth");
  const SingleScattering<float> air(medium);
  // A millimetre of depth is 226 m of shadow; air there is lit through 38 optical depths and more.
  const auto before = Inscatter(air, ThroughTheShadow(medium, -1e-3), kFine);
  const auto after = Inscatter(air, ThroughTheShadow(medium, 1e-3), kFine);
  EXPECT_TRUE(tests::BandsNear(after, before, 1e-4)) << "panels begin and end elsewhere";
  // A segment cut in two in the light, on the edges of the shadow or in it has the same light.
  const SingleScattering<double> fine(medium);
  const ViewRay whole = ThroughTheShadow(medium, 3e3);
  const ShadowSpan shadow =
      PlanetShadow(whole, {0.0, whole.length_m, RayEnd::kLength}, medium.planet_radius_m);
  const auto all = Inscatter(fine, whole, kFine);
  for (const double cut_m :
       {0.5 * shadow.dark_begin_m, std::nextafter(shadow.dark_begin_m, 0.0), shadow.dark_begin_m,
        500e3, shadow.dark_end_m, std::nextafter(shadow.dark_end_m, 1e6), 990e3}) {
    ViewRay first = whole;
    first.length_m = cut_m;
    const double r = medium.planet_radius_m + whole.altitude_m;
    const double r_cut = std::sqrt(r * r + 2.0 * r * whole.mu * cut_m + cut_m * cut_m);
    const ViewRay second{r_cut - medium.planet_radius_m, (r * whole.mu + cut_m) / r_cut,
                         (r * whole.mu_s + whole.nu * cut_m) / r_cut, whole.nu,
                         whole.length_m - cut_m};
    const auto near = Inscatter(fine, first, kFine);
    const auto far = Inscatter(fine, second, kFine);
    const auto through = fine.TransmittanceAlong(first);
    for (std::size_t band = 0; band < fine.bands(); ++band) {
      EXPECT_NEAR((near[band] + through[band] * far[band]) / all[band], 1.0, 3e-4)
          << "cut at " << cut_m << " m: 16 nodes a panel";
    }
  }
}

// Hard case 29.
TEST(SingleScattering, ThickAirFadesToZeroWithEqualEffort) {
  const ViewRay level{2.0, 0.0, 0.5, 0.3};
  std::vector<std::size_t> nodes;
  for (const double depth : {0.05, 5.0, 50.0, 5000.0}) {
    Medium medium = MediumPreset("earth");
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
      medium.mie_extinction_per_m[band] = depth / medium.mie_scale_height_m;
      medium.mie_scattering_per_m[band] = 0.9 * medium.mie_extinction_per_m[band];
    }
    const SingleScattering<float> air(medium);
    for (const double mu : {1.0, 0.0}) {
      const double truth = reference::OpticalDepthAlong(medium, {2.0, mu, 1.0, mu}).tau[0];
      const double found = static_cast<double>(air.TransmittanceToSpace(2.0, mu)[0]);
      EXPECT_NEAR(found, std::exp(-truth), 2e-5 * std::max(truth, 1.0) * std::exp(-truth) + 1e-37)
          << depth << ", mu " << mu;
      EXPECT_NE(std::fpclassify(static_cast<float>(found)), FP_SUBNORMAL)
          << "numbers that processors are slow with";
    }
    for (const double mu_s : {0.5, 0.01}) {
      ViewRay ray = level;
      ray.mu_s = mu_s;
      const auto light = Inscatter(air, ray, kFine);
      for (std::size_t band = 0; band < air.bands(); ++band) {
        EXPECT_TRUE(std::isfinite(light[band])) << depth;
        EXPECT_GE(light[band], 0.0F) << depth;
        EXPECT_NE(std::fpclassify(light[band]), FP_SUBNORMAL) << depth;
      }
    }
    nodes.push_back(air.Sample(level, kFine).count);
  }
  EXPECT_EQ(nodes, std::vector<std::size_t>(nodes.size(), nodes.front()));
}

/// The largest relative errors of rays of all kinds.
struct EdgeErrors {
  double depth = 0.0, light = 0.0;
};

EdgeErrors ErrorsAtTheEdge(const Medium& medium) {
  const SingleScattering<double> air(medium);
  EdgeErrors errors;
  for (int i = 1; i <= tests::ScaledDown(16, 8); ++i) {
    const double top = medium.atmosphere_height_m;
    const double altitude = std::array{0.0, 1.0, 0.5, 2.0}[static_cast<std::size_t>(i % 4)] *
                            (i % 4 == 1 ? medium.mie_scale_height_m : top);
    const double view = i % 3 == 0 ? 80.0 + 20.0 * Halton(i, 2) : 180.0 * Halton(i, 2);
    const ViewRay ray = RayFromAngles(altitude, view, 180.0 * Halton(i, 3), 95.0 * Halton(i, 5));
    const reference::RayRadiance truth = reference::SingleScatteringAlong(medium, ray);
    const std::vector<double> tau = reference::OpticalDepthAlong(medium, ray).tau;
    const auto depth = air.OpticalDepthAlong(ray);
    const auto light = Inscatter(air, ray, kFine);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      EXPECT_TRUE(std::isfinite(depth[band]) && std::isfinite(light[band])) << i;
      if (tau[band] > 1e-7)
        errors.depth = std::max(errors.depth, std::abs(depth[band] / tau[band] - 1.0));
      if (truth.inscatter[band] > 1e-9)
        errors.light = std::max(errors.light, std::abs(light[band] / truth.inscatter[band] - 1.0));
    }
  }
  return errors;
}

// Hard case 31.
TEST(SingleScattering, AgreesWithTheReferenceAtTheLimitsOfMedia) {
  const auto edge = [](const char* preset, const auto& make) {
    Medium medium = MediumPreset(preset);
    make(medium);
    EXPECT_EQ(FindFault(medium), std::nullopt);
    return medium;
  };
  // Keeps the column of aerosol in a layer of another scale height.
  const auto with_layer = [](double height_m) {
    return [height_m](Medium& m) {
      for (auto* list : {&m.mie_scattering_per_m, &m.mie_extinction_per_m})
        for (double& coefficient : *list) coefficient *= m.mie_scale_height_m / height_m;
      m.mie_scale_height_m = height_m;
    };
  };
  const struct {
    const char* name;
    Medium medium;
    double light_error;
  } edges[] = {
      {"the smallest planet",
       edge("bruneton2017", [](Medium& m) { m.planet_radius_m = 25.0 * 8000.0; }), 1e-3},
      {"the smallest planet under smooth ozone",
       edge("earth", [](Medium& m) { m.planet_radius_m = 3.0 * m.ozone.top_m + 25e3; }), 1e-3},
      {"the smallest planet of dust",
       edge("mars", [](Medium& m) { m.planet_radius_m = 25.0 * m.mie_scale_height_m; }), 1e-3},
      {"the largest planet", edge("earth", [](Medium& m) { m.planet_radius_m = 1e8; }), 1e-4},
      {"the lowest top", edge("bruneton2017", [](Medium& m) { m.atmosphere_height_m = 40e3; }),
       1e-4},
      {"the highest top", edge("bruneton2017", [](Medium& m) { m.atmosphere_height_m = 2.4e6; }),
       1e-3},
      {"the thinnest layer", edge("earth", with_layer(100.0)), 1e-2},
      {"the thickest layer", edge("earth", with_layer(200e3)), 1e-3},
  };
  for (const auto& [name, medium, light_error] : edges) {
    const EdgeErrors errors = ErrorsAtTheEdge(medium);
    EXPECT_LT(errors.depth, 6e-4) << name << ": 0.19 / 25^2, and the rule of smooth ozone";
    EXPECT_LT(errors.light, light_error)
        << name << ": three times what the series leaves of columns; nodes of a thin layer";
  }
}

// Hard case 31.
TEST(SingleScattering, SharpestLobesAgreeWithTheReference) {
  for (const double g : {-0.999, -0.5, 0.0, 0.999}) {
    for (const PhaseKind kind : {PhaseKind::kHenyeyGreenstein, PhaseKind::kCornetteShanks}) {
      Medium medium = MediumPreset("bruneton2017");
      medium.mie_phase.front() = {.kind = kind, .g = g};
      const SingleScattering<float> air(medium);
      for (const double azimuth : {0.0, 1.0, 90.0, 180.0}) {
        const ViewRay ray = RayFromAngles(2.0, 50.0, azimuth, 50.0);
        EXPECT_TRUE(tests::BandsNear(Inscatter(air, ray, kFine),
                                     reference::SingleScatteringAlong(medium, ray).inscatter, 2e-3))
            << g << ' ' << azimuth << ": float keeps 1 - nu to 1e-7, the lobe is 1e-3 wide";
      }
    }
  }
}

// Hard case 31.
TEST(SingleScattering, LayersBeyondTheLimitsAreRefusedWithTheRange) {
  for (const double beyond_m : {99.0, 2.1e5}) {
    Medium medium = MediumPreset("earth");
    medium.mie_scale_height_m = beyond_m;
    const auto fault = FindFault(medium);
    ASSERT_TRUE(fault.has_value()) << beyond_m;
    EXPECT_EQ(fault->key, "mie.scale_height_m");
    EXPECT_NE(fault->text.find("[100, 200000]"), std::string::npos) << fault->text;
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
