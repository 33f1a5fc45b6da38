// SPDX-License-Identifier: MIT
#include "lut/sky/sky_view.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "lut/sky/sky_row_kernel.h"
#include "tests/fixtures/bands_near.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sky_view_errors.h"
#include "tests/fixtures/small_light.h"
#include "tests/fixtures/solved_media.h"

namespace alpenglow::lut {
namespace {

constexpr double kAltitudes_m[] = {0.0, 2.0, 1500.0, 10e3, 40e3, 400e3};
constexpr double kElevations_deg[] = {90.0, 60.0, 10.0, 1.0, -1.0, -4.0, -10.0};

double Degrees(double degrees) { return degrees * kRadiansPerDegree; }
double Sine(double degrees) { return std::sin(Degrees(degrees)); }

/// Returns the sky of the default atmosphere under a sun at an elevation.
SkyView ViewOfEarth(double altitude_m, double elevation_deg) {
  return SkyView(tests::Earth().single_scattering(), tests::Earth().multiple_scattering(),
                 altitude_m, Sine(elevation_deg));
}

const DirectSky& DirectSkyOfEarth() {
  static const DirectSky direct(tests::Earth().medium(), tests::Earth().multiple_scattering());
  return direct;
}

TEST(SkyViewMap, CoordinatesAreInvertible) {
  for (const double altitude_m : kAltitudes_m) {
    const SkyViewMap map(MediumPreset("earth"), altitude_m, Sine(-4.0));
    for (double v = 0.0; v <= 1.0; v += 1.0 / 64.0) {
      // At the air's upper edge the angle is quadratic in v: 1e-16 of it are 1e-8 of v.
      EXPECT_NEAR(map.SkyCoordinate(map.SkyZenithAngle(v)), v, map.sees_upper_edge() ? 1e-7 : 1e-9)
          << altitude_m;
      // Next to the horizon the angle is quadratic in
      // v: 1e-16 of it are 1e-7 of v at the least dip.
      EXPECT_NEAR(map.GroundCoordinate(map.GroundZenithAngle(v)), v, 1e-6) << altitude_m;
      EXPECT_NEAR(map.AzimuthCoordinate(map.Azimuth(v)), v, 1e-9) << altitude_m;
    }
    EXPECT_NEAR(map.GroundZenithAngle(1.0), kPi, 1e-12);
    EXPECT_NEAR(map.SkyZenithAngle(1.0), map.upper_edge_zenith_angle_rad(), 1e-12);
  }
}

TEST(SkyViewMap, HorizonIsWhereRaysBeginToMeetTheGround) {
  const Medium medium = MediumPreset("earth");
  for (const double altitude_m : {2.0, 10e3, 400e3}) {
    const double horizon = SkyViewMap(medium, altitude_m, 1.0).horizon_zenith_angle_rad();
    for (const double hair : {-1e-9, 1e-9}) {
      const RayExtent extent = ExtentOf({altitude_m, std::cos(horizon + hair), 1.0, 0.0},
                                        medium.planet_radius_m, medium.atmosphere_height_m);
      EXPECT_EQ(extent.end == RayEnd::kGround, hair > 0.0) << altitude_m;
    }
  }
}

TEST(SkyView, MeanErrorIsBelowThreePerMille) {
  constexpr int kDirections = tests::ScaledDown(60, 20);
  for (const double altitude_m : kAltitudes_m) {
    for (const double elevation_deg : kElevations_deg) {
      const SkyView view = ViewOfEarth(altitude_m, elevation_deg);
      const SkyViewErrors errors =
          ErrorsOf(view, DirectSkyOfEarth(), altitude_m, Sine(elevation_deg), kDirections);
      EXPECT_LT(errors.Rms(), 0.003) << altitude_m << " m, sun at " << elevation_deg;
      EXPECT_LT(errors.Percentile(95.0), 0.006) << altitude_m << " m, sun at " << elevation_deg;
    }
  }
}

TEST(SkyView, OfHazeIsEquallyAccurate) {
  const Medium medium = MediumPreset("hazy");
  const SingleScattering<float> air(medium);
  const MultipleScattering multiple_scattering(medium);
  const DirectSky direct(medium, multiple_scattering);
  for (const double altitude_m : {2.0, 10e3}) {
    for (const double elevation_deg : {60.0, 1.0, -4.0}) {
      const double mu_s = Sine(elevation_deg);
      const SkyView view(air, multiple_scattering, altitude_m, mu_s);
      EXPECT_LT(ErrorsOf(view, direct, altitude_m, mu_s, 100).Rms(), 0.003)
          << altitude_m << " m, sun at " << elevation_deg;
    }
  }
}

// Hard case 7.
TEST(SkyView, HasNoStripeAtTheHorizon) {
  for (const double altitude_m : {2.0, 10e3, 400e3}) {
    for (const double elevation_deg : {10.0, 1.0, -4.0}) {
      const SkyView view = ViewOfEarth(altitude_m, elevation_deg);
      std::vector<double> from_horizon_deg{-6e-5, 6e-5};
      for (double at = -0.5; at < 0.5; at += tests::ScaledDown(0.043, 0.172))
        from_horizon_deg.push_back(at);
      for (const double degrees : from_horizon_deg) {
        const double zenith = view.map().horizon_zenith_angle_rad() + Degrees(degrees);
        const auto exact =
            DirectSkyOfEarth().Radiance(SkyRay(altitude_m, zenith, Sine(elevation_deg), 0.8));
        const bool is_edge = std::abs(degrees) < 1e-4 && elevation_deg == 10.0;
        EXPECT_TRUE(tests::BandsNear(view.Radiance(zenith, 0.8), exact, is_edge ? 0.003 : 0.006))
            << altitude_m << " m, sun at " << elevation_deg << ", " << degrees;
      }
    }
  }
}

// Hard case 23.
TEST(SkyView, IsFiniteAndNotNegativeEverywhere) {
  for (const double altitude_m : {-400.0, 0.0, 119999.0, 120001.0, 36e6, 1e9}) {
    for (const double elevation_deg : {90.0, 0.0, -6.0, -18.0, -60.0, -90.0}) {
      const SkyView view = ViewOfEarth(altitude_m, elevation_deg);
      for (int i = 1; i <= 200; ++i) {
        const Spectrum light = view.Radiance(kPi * Halton(i, 2), 2.0 * kPi * Halton(i, 3));
        for (std::size_t band = 0; band < light.size(); ++band) {
          EXPECT_TRUE(std::isfinite(light[band]) && light[band] >= 0.0F)
              << altitude_m << " m, sun at " << elevation_deg;
        }
      }
    }
  }
}

// Hard case 10.
TEST(SkyView, ZenithAndNadirDoNotDependOnAzimuth) {
  const SkyView view = ViewOfEarth(10e3, 20.0);
  for (const double zenith : {0.0, kPi}) {
    const double towards = view.Radiance(zenith, 0.0)[1];
    EXPECT_NEAR(view.Radiance(zenith, 2.0)[1], towards, 1e-5 * towards) << "float";
    EXPECT_NEAR(view.Radiance(zenith, kPi)[1], towards, 1e-5 * towards) << "float";
  }
}

// Hard case 37.
TEST(SkyView, IsSymmetricAroundTheSunWithoutASeam) {
  const SkyView view = ViewOfEarth(2.0, -3.0);
  for (const double zenith : {0.3, 1.2, 1.55, 2.0}) {
    EXPECT_EQ(view.Radiance(zenith, 1.0)[2], view.Radiance(zenith, -1.0)[2]);
    EXPECT_NEAR(view.Radiance(zenith, 1.0)[2], view.Radiance(zenith, 1.0 - 4.0 * kPi)[2],
                1e-6F * view.Radiance(zenith, 1.0)[2])
        << "remainder of a double";
    const double before = view.Radiance(zenith, kPi - 1e-4)[2];
    EXPECT_NEAR(view.Radiance(zenith, kPi + 1e-4)[2], before, 1e-6 * before);
  }
}

TEST(SkyView, ARowEqualsSingleLookUps) {
  const SkyView view = ViewOfEarth(1500.0, 5.0);
  std::vector<double> azimuths;
  for (int i = 0; i < 777; ++i) azimuths.push_back(0.01 * i - 2.0);
  const SkyAzimuths prepared(view, azimuths);
  std::vector<float> row(azimuths.size() * view.stride());
  view.FillRow(1.4, prepared, row);
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    const Spectrum one = view.Radiance(1.4, azimuths[i]);
    for (std::size_t band = 0; band < view.bands(); ++band)
      EXPECT_FLOAT_EQ(row[i * view.stride() + band], one[band]);
  }
}

TEST(SkyView, BandsDoNotDependOnTheirNumber) {
  const Medium all = MediumPreset("earth", WavelengthSet(6));
  const Medium one = MediumPreset("earth", {all.wavelengths_nm[4]});
  const SkyView view(SingleScattering<float>(all), MultipleScattering(all, tests::kSmallLight), 2.0,
                     0.5);
  const SkyView single(SingleScattering<float>(one), MultipleScattering(one, tests::kSmallLight),
                       2.0, 0.5);
  EXPECT_EQ(view.stride(), 8U);
  const float expected = single.Radiance(1.0, 0.7)[0];
  EXPECT_NEAR(view.Radiance(1.0, 0.7)[4], expected, 1e-3F * expected)
      << "quadrature nodes follow the largest extinction of the bands";
}

// Returns the largest second difference along a line of values, relative to the middle one.
double LargestBend(const std::vector<double>& values) {
  double largest = 0.0;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double bend = std::abs(values[i + 1] - 2.0 * values[i] + values[i - 1]);
    largest = std::max(largest, bend / values[i]);
  }
  return largest;
}

// Hard case 22.
TEST(SkyView, TwilightHasNoBlocksInAzimuth) {
  for (const double altitude_m : {2.0, 10e3}) {
    for (const double elevation_deg : {-4.0, -8.0, -12.0}) {
      const SkyView view = ViewOfEarth(altitude_m, elevation_deg);
      const double mu_s = Sine(elevation_deg);
      for (const double above_deg : {1.0, 5.0, 20.0, 60.0}) {
        const double zenith = view.map().horizon_zenith_angle_rad() - Degrees(above_deg);
        std::vector<double> along;
        // A block would be as wide as a column of the table, 64 of these steps.
        for (int i = 0; i < tests::ScaledDown(1024, 160); ++i) {
          const double azimuth = 2.0 * kPi * i / 2048;
          // The bends of the aureole are real.
          const double exact =
              DirectSkyOfEarth().Radiance(SkyRay(altitude_m, zenith, mu_s, azimuth))[1];
          along.push_back(double{view.Radiance(zenith, azimuth)[1]} / exact);
        }
        // Two neighbouring pixels of a smooth sky differ by 1 % at most, and their steps by much
        // less: a bend of 5e-4 is invisible however bright the picture is developed, because
        // exposure scales both.
        EXPECT_LT(LargestBend(along), 5e-4)
            << altitude_m << " m, sun at " << elevation_deg << ", " << above_deg << " above";
      }
    }
  }
}

// Hard case 22.
TEST(SkyView, TheTerminatorOnTheLimbHasNoBlocks) {
  // Seen from space light dies within a few degrees of azimuth: there the bends are real.

  const double step = 2.0 * kPi / 2048;
  for (const double elevation_deg : {1.0, -4.0, -10.0}) {
    const SkyView view = ViewOfEarth(400e3, elevation_deg);
    const double mu_s = Sine(elevation_deg);
    for (const double above_deg : {-5.0, 0.3, 1.0}) {
      const double zenith = view.map().horizon_zenith_angle_rad() - Degrees(above_deg);
      std::vector<double> ratio;
      for (int i = 300; i < tests::ScaledDown(800, 400); ++i) {
        const double exact = DirectSkyOfEarth().Radiance(SkyRay(400e3, zenith, mu_s, step * i))[1];
        if (exact < 1e-6) break;  // some 1e-5 of the sky by day
        ratio.push_back(double{view.Radiance(zenith, step * i)[1]} / exact);
      }
      EXPECT_LT(LargestBend(ratio), 0.004)
          << "sun at " << elevation_deg << ", " << above_deg << " above the horizon";
    }
  }
}

// Hard cases 22, 33.
TEST(SkyView, TwilightHasNoStepsFromMinuteToMinute) {
  constexpr double kZeniths_deg[] = {0.0, 45.0, 85.0};
  std::array<std::vector<double>, 3> stops;
  for (double elevation_deg = 3.0; elevation_deg > -8.1; elevation_deg -= 0.25) {
    const SkyView view = ViewOfEarth(2.0, elevation_deg);
    for (std::size_t k = 0; k < 3; ++k)
      stops[k].push_back(std::log(double{view.Radiance(Degrees(kZeniths_deg[k]), 0.5)[1]}));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 1; i + 1 < stops[k].size(); ++i) {
      EXPECT_NEAR(stops[k][i + 1] - stops[k][i], stops[k][i] - stops[k][i - 1], 0.02)
          << "sun at " << 3.0 - 0.25 * static_cast<double>(i) << ", zenith angle "
          << kZeniths_deg[k] << ": the pace of dusk changes by less than 2 % in a minute";
    }
  }
}

// Hard case 38.
TEST(SkyView, TooFewNodesAreRefused) {
  const auto refuse = [&](const SkyViewSize& size) {
    const SkyView view(tests::Earth().single_scattering(), tests::Earth().multiple_scattering(),
                       0.0, 1.0, size);
  };
  EXPECT_THROW(refuse({.sky_rows = 4}), InputError);
  EXPECT_THROW(refuse({.ground_rows = 4}), InputError);
  EXPECT_THROW(refuse({.azimuths = 2}), InputError);
}

// Colours of an image may have a negative channel. The spectra behind them are those of light.
TEST(SkyView, DeepTwilightHasNegativeRedButNoNegativeLight) {
  const Medium& medium = tests::Earth().medium();
  const BandColour colour(medium.wavelengths_nm);
  int with_negative_red = 0;
  for (const double elevation_deg : {-24.0, -25.0, -26.0, -30.0}) {
    for (const double altitude_m : {2.0, 9e3, 30e3}) {
      const SkyView view = ViewOfEarth(altitude_m, elevation_deg);
      for (double zenith_deg = 0.5; zenith_deg < 180.0; zenith_deg += 3.0) {
        for (const double azimuth_deg : {0.0, 60.0, 120.0, 180.0}) {
          const Spectrum radiance = view.Radiance(Degrees(zenith_deg), Degrees(azimuth_deg));
          std::vector<double> light;
          for (std::size_t band = 0; band < radiance.size(); ++band) {
            EXPECT_GE(radiance[band], 0.0F) << elevation_deg << " " << zenith_deg;
            light.push_back(double{radiance[band]} * medium.solar_irradiance[band]);
          }
          EXPECT_GE(colour.Xyz(light)[1], 0.0) << elevation_deg << " " << zenith_deg;
          if (colour.LinearSrgb(light)[0] < 0.0) ++with_negative_red;
        }
      }
    }
  }
  EXPECT_GT(with_negative_red, 100) << "ozone leaves a blue that displays do not have";
}

TEST(SkyRowKernel, KeepsNanAndRemovesNegativeLight) {
  std::vector<float> row(4 * SkyNodeFloats(1), 0.0F), phase(4 * (kSkyPhaseNodes + 1), 0.0F);
  row[4] = std::nanf("");
  row[5] = -1.0F;
  row[6] = 2.0F;
  const std::int32_t cell = 0;
  const std::array<float, 4> weights{1.0F, 0.0F, 0.0F, 0.0F};
  const float half_sine2 = 0.5F;
  std::array<float, 4> radiance{};
  Kernel<SkyRowKernel>().fill({.terms = 1,
                               .row = row.data(),
                               .phase = phase.data(),
                               .cell = &cell,
                               .weights = weights.data(),
                               .half_sine2 = &half_sine2,
                               .offset = 0.0F,
                               .scale = 1.0F,
                               .count = 1,
                               .radiance = radiance.data(),
                               .radiance_stride = 4});
  EXPECT_TRUE(std::isnan(radiance[0]));
  EXPECT_EQ(radiance[1], 0.0F);
  EXPECT_EQ(radiance[2], 2.0F);
}

}  // namespace
}  // namespace alpenglow::lut
