// SPDX-License-Identifier: MIT
// Light of the sun's disk on ground at any height, against the ray equation and against integration
// along bent rays.
#include "atmosphere/refraction/refracted_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/reference/reference_solution.h"
#include "tests/fixtures/refracted_twilight.h"

namespace alpenglow::atmosphere {
namespace {

constexpr std::array kLitHeights_m{0.0, 3000.0, 8000.0};
constexpr std::array kSunElevations_deg{0.1, 0.3, 1.0, 2.0, 5.0, 10.0};

Medium EarthOfThreeBands() { return MediumPreset("earth", {450.0, 550.0, 650.0}); }

Medium EarthOfMolecules() {
  Medium medium = EarthOfThreeBands();
  medium.mie_scattering_per_m.assign(3, 0.0);
  medium.mie_extinction_per_m.assign(3, 0.0);
  medium.ozone_absorption_per_m.assign(3, 0.0);
  return medium;
}

TEST(RefractedBeam, IsWithinOnePerCentOfTheRayEquationInMolecules) {
  const Medium medium = EarthOfMolecules();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  for (const double height_m : kLitHeights_m) {
    for (const double elevation_deg : kSunElevations_deg) {
      constexpr double kStep = 2e-4;
      const double seen = elevation_deg * kRadiansPerDegree;
      const auto found = equation.Follow(seen, height_m);
      const double slope = (equation.Follow(seen + kStep, height_m).refraction_rad -
                            equation.Follow(seen - kStep, height_m).refraction_rad) /
                           (2.0 * kStep);
      const double spread = std::cos(seen) / std::cos(seen - found.refraction_rad) / (1.0 - slope);
      const Bands<float> left = beam.Left(air, height_m, std::sin(seen));
      for (std::size_t band = 0; band < 3; ++band) {
        const double expected =
            spread * std::exp(-medium.rayleigh_scattering_per_m[band] * found.column_m);
        // Columns of bent rays are good to 2e-3, which is 0.8 % of blue light through a depth of 4 on
        // the horizon; the table adds its interpolation.
        EXPECT_NEAR(static_cast<double>(left[band]) / expected, 1.0, 0.01)
            << height_m << " m, " << elevation_deg << " degrees, band " << band;
      }
    }
  }
}

TEST(RefractedBeam, IsWithinTwoPerCentOfRefractedRaysInAllAir) {
  const Medium medium = EarthOfThreeBands();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  for (const double height_m : kLitHeights_m) {
    const tests::RefractedTwilight rays(medium, height_m);
    for (const double elevation_deg : kSunElevations_deg) {
      const double seen = elevation_deg * kRadiansPerDegree;
      const tests::BandValues expected = rays.Beam(seen, height_m);
      const Bands<float> left = beam.Left(air, height_m, std::sin(seen));
      for (std::size_t band = 0; band < 3; ++band)
        EXPECT_NEAR(static_cast<double>(left[band]) / expected[band], 1.0, 0.02)
            << "ozone takes up to 1.4 % more of green along a bent ray; " << height_m << " m, "
            << elevation_deg << " degrees, band " << band;
    }
  }
}

TEST(RefractedBeam, BetweenItsNodesIsWithinThreePerCentOfRefractedRays) {
  const Medium medium = EarthOfThreeBands();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  for (const double height_m : {20.0, 200.0, 700.0, 1500.0, 5500.0, 11e3}) {
    const tests::RefractedTwilight rays(medium, height_m);
    const double horizon_rad = GrazingElevation(GentleAirOf(medium), height_m);
    for (const double over_deg : {0.3, 0.5, 1.1, 3.0, 20.0}) {
      const double seen = horizon_rad + over_deg * kRadiansPerDegree;
      const tests::BandValues expected = rays.Beam(seen, height_m);
      const Bands<float> left = beam.Left(air, height_m, std::sin(seen));
      for (std::size_t band = 0; band < 3; ++band)
        EXPECT_NEAR(static_cast<double>(left[band]) / expected[band], 1.0, 0.03)
            << "linear between nodes of columns; " << height_m << " m, " << over_deg
            << " degrees over the horizon, band " << band;
    }
  }
}

TEST(RefractedBeam, FadesSmoothlyWhileTheSunSinks) {
  // A sun that sinks by a minute of arc: what is left falls by a share that changes by a tenth of
  // itself at most from each to the next, or by 1e-3 high up where it hardly falls.
  constexpr double kMinute = kRadiansPerDegree / 60.0;
  const Medium medium = EarthOfThreeBands();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  for (const double height_m : kLitHeights_m) {
    const auto log_at = [&](double minutes) {
      return std::log(
          static_cast<double>(beam.Left(air, height_m, std::sin(minutes * kMinute))[2]));
    };
    double before = log_at(600.0) - log_at(599.0);
    for (double minutes = 599.0; minutes > 0.0; minutes -= 1.0) {
      const double fall = log_at(minutes) - log_at(minutes - 1.0);
      EXPECT_GT(fall, 0.0) << height_m << " m, " << minutes;
      EXPECT_NEAR(fall, before, std::max(0.1 * before, 1e-3)) << height_m << " m, " << minutes;
      before = fall;
    }
  }
}

TEST(RefractedBeam, IsThatOfStraightRaysWhereNothingBends) {
  Medium medium = EarthOfThreeBands();
  medium.rayleigh_scattering_per_m.assign(3, 0.0);
  const SingleScattering<float> air(medium);
  EXPECT_EQ(RefractedBeam(medium).Left(air, 100.0, 0.01), air.TransmittanceToSpace(100.0, 0.01));
}

TEST(RefractedBeam, StaysBelowThatOfStraightRaysAtAnyHeight) {
  const Medium medium = EarthOfThreeBands();
  const RefractedBeam beam(medium);
  for (const double height_m : {-50.0, 0.0, 9e3, 39e3, 41e3, 99e3, 400e3}) {
    for (const double mu : {-1.0, -0.05, 0.0, 0.01, 0.3, 1.0}) {
      const Bands<float> over = beam.OverStraight(height_m, mu);
      for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_GE(over[band], 0.0F) << height_m << " m, " << mu;
        EXPECT_LE(over[band], 1.0F) << height_m << " m, " << mu;
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
