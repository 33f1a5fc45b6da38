// SPDX-License-Identifier: MIT
// Light of all orders is right in hazy and dusty air, where aerosol throws it forward.
#include "lut/multiple_scattering/delta_m.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/error_statistics.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium_presets.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::lut {
namespace {

Medium Haze(double scattering_per_m, double extinction_per_m) {
  Medium medium = MediumPreset("bruneton2017");
  medium.mie_scattering_per_m.assign(3, scattering_per_m);
  medium.mie_extinction_per_m.assign(3, extinction_per_m);
  medium.mie_phase = {tests::LobeOf(0.8)};
  return medium;
}

/// A view into the air, degrees and metres, and the radiance of paths in every band
/// (skylut eval --method path-trace --max-error 0.25%).
struct TracedView {
  double altitude_m, zenith_deg, azimuth_deg, sun_zenith_deg, length_m;
  std::vector<double> radiance;
};
constexpr double kToSpace_m = 1e9;

/// Returns relative errors of light of all orders, in the bands of the medium, which may be fewer
/// than were traced.
std::vector<double> ErrorsOf(const Medium& medium, const MultipleScatteringOptions& options,
                             const std::vector<TracedView>& views) {
  const MultipleScattering light(medium, options);
  const SingleScattering<float> air(medium);
  std::vector<double> errors;
  const std::size_t bands = medium.wavelengths_nm.size();
  for (const TracedView& view : views) {
    ViewRay ray =
        RayFromAngles(view.altitude_m, view.zenith_deg, view.azimuth_deg, view.sun_zenith_deg);
    if (view.length_m < kToSpace_m) ray.length_m = view.length_m;
    const auto samples = air.Sample(ray, {.nodes = 20, .split_ozone = true, .dark_samples = true});
    const auto once = air.Inscatter(air.Scatter(samples), ray.nu);
    const auto more = light.InscatterAlong(samples, ray.nu);
    for (std::size_t band = 0; band < bands; ++band)
      errors.push_back(static_cast<double>(once[band] + more[band]) / view.radiance[band] - 1.0);
  }
  return errors;
}

double Largest(const std::vector<double>& errors) {
  double largest = 0.0;
  for (const double error : errors) largest = std::max(largest, std::abs(error));
  return largest;
}

// The usual options take seconds for thick air.
MultipleScatteringOptions WithFewSuns(MultipleScatteringOptions options) {
  options.sun_angles = tests::ScaledDown(20, 14);
  return options;
}

TEST(DeltaM, KeepsAbsorptionAndTruncatesThePhaseFunction) {
  const Medium mars = MediumPreset("mars");
  const DeltaScaledMedium rest = WithoutPeak(mars, 8);
  const std::size_t bands = mars.wavelengths_nm.size();
  for (std::size_t band = 0; band < bands; ++band) {
    const double absorbed = mars.mie_extinction_per_m[band] - mars.mie_scattering_per_m[band];
    EXPECT_NEAR(rest.medium.mie_extinction_per_m[band] - rest.medium.mie_scattering_per_m[band],
                absorbed, 1e-12 * mars.mie_extinction_per_m[band]);
    EXPECT_NEAR(rest.chi[band], 1.0, 1e-12) << "what is left scatters all that it takes";
    // Only the smooth backward half remains of the first degree that is not kept.
    EXPECT_NEAR(rest.chi[9 * bands + band], 0.0, 5e-3);
    EXPECT_GT(rest.share[band], 0.1) << "of dust";
  }
}

TEST(DeltaM, WithoutAerosolChangesNothing) {
  const Medium clear = Haze(0.0, 0.0);
  const SingleScattering<float> air(clear);
  const ViewRay ray = RayFromAngles(2.0, 50.0, 10.0, 60.0);
  const auto samples = air.Sample(ray, {.nodes = 12, .dark_samples = true});
  const Spectrum light = DeltaM(clear, 6).Along(samples, ray.nu);
  for (std::size_t band = 0; band < 3; ++band) EXPECT_EQ(light[band], 0.0F);
}

TEST(DeltaM, HazeAgreesWithPathsToHalfAPercent) {
  const Medium haze = Haze(7.992e-5, 8.88e-5);  // optical depth 0.1, the stored set haze20mix
  const std::vector<double> errors =
      ErrorsOf(haze, OptionsFor(haze),
               {{2.0, 81.6667, 36.0, 57.5, kToSpace_m, {0.09896458, 0.08325672, 0.07381091}},
                {3000.0, 52.0, 72.0, 71.25, kToSpace_m, {0.02162225, 0.00907426, 0.004418556}},
                {2.0, 82.8889, 144.0, 78.125, kToSpace_m, {0.04227244, 0.03291204, 0.02312036}},
                {2.0, 80.0, 5.07718, 80.0, kToSpace_m, {0.262923, 0.4881752, 0.7311241}},
                {2.0, 70.0, 0.0, 80.0, kToSpace_m, {0.1260689, 0.1947047, 0.2745973}},
                {1500.0, 89.5, 10.0, 80.0, 20000.0, {0.1167570, 0.2060016, 0.3049198}}});
  EXPECT_LT(RmsOf(errors), 5e-3);
  EXPECT_LT(Largest(errors), 2e-2);
}

TEST(DeltaM, HazeOfOpticalDepthOneAgreesWithPathsToTwoPercent) {
  const Medium haze = Haze(7.5e-4, 8.333e-4);
  const std::vector<double> errors =
      ErrorsOf(haze, WithFewSuns(OptionsFor(haze)),
               {{2.0, 81.6667, 36.0, 57.5, kToSpace_m, {0.1010557, 0.1168100, 0.1310469}},
                {3000.0, 52.0, 72.0, 71.25, kToSpace_m, {0.02492177, 0.01273711, 0.008352072}},
                {2.0, 80.0, 5.07718, 80.0, kToSpace_m, {0.04870897, 0.0826584, 0.1212603}},
                {2.0, 70.0, 0.0, 80.0, kToSpace_m, {0.07335502, 0.1183075, 0.1695171}},
                {2.0, 88.0, 0.0, 75.0, 5000.0, {0.05511213, 0.08170906, 0.1076473}}});
  EXPECT_LT(RmsOf(errors), 2e-2);
}

TEST(DeltaM, DustOfMarsAgreesWithPathsToTwoPercent) {
  const Medium mars = MediumPreset("mars");
  const std::vector<double> errors = ErrorsOf(
      mars, WithFewSuns(OptionsFor(mars)),
      {{2.0, 81.6667, 36.0, 57.5, kToSpace_m, {0.06230871, 0.08721707, 0.1025269, 0.1209562}},
       {3000.0, 52.0, 72.0, 71.25, kToSpace_m, {0.01229776, 0.01729666, 0.02030115, 0.02400659}},
       {2.0, 80.0, 5.07718, 80.0, kToSpace_m, {1.391229, 1.363444, 1.333030, 1.265028}},
       {2.0, 70.0, 0.0, 80.0, kToSpace_m, {0.2709998, 0.3192811, 0.3431749, 0.3703000}},
       {2.0, 88.0, 0.0, 75.0, 5000.0, {0.0419125, 0.0502959, 0.0546645, 0.0593626}}});
  EXPECT_LT(RmsOf(errors), 2e-2);
}

TEST(ThickAir, MoleculesOfOpticalDepthFiveAgreeWithPathsToOnePercent) {
  Medium molecules = Haze(0.0, 0.0);
  for (std::size_t band = 0; band < 3; ++band) {
    molecules.rayleigh_scattering_per_m[band] =
        std::array{0.5, 2.0, 5.0}[band] / molecules.rayleigh_scale_height_m;
  }
  // The last band takes hundreds of orders.
  molecules = tests::WithBands(molecules, 0, tests::ScaledDown(3, 2));
  const std::vector<double> errors =
      ErrorsOf(molecules, WithFewSuns(OptionsFor(molecules)),
               {{2.0, 81.6667, 36.0, 57.5, kToSpace_m, {0.09159932, 0.04034134, 0.02075372}},
                {3000.0, 52.0, 72.0, 71.25, kToSpace_m, {0.03382878, 0.04194107, 0.03368006}},
                {2.0, 82.8889, 144.0, 78.125, kToSpace_m, {0.03936788, 0.009450284, 0.005408709}},
                {2.0, 20.0, 90.0, 30.0, kToSpace_m, {0.05234051, 0.1042153, 0.08256036}},
                {10000.0, 120.0, 60.0, 60.0, 30000.0, {0.04138997, 0.07301351, 0.08362427}},
                {2.0, 70.0, 0.0, 80.0, kToSpace_m, {0.0395654, 0.0103269, 0.005680471}}});
  EXPECT_LT(RmsOf(errors), 1e-2);
}

// The optical depth of the haze along the segments is 20 to 120.
TEST(DeltaM, SegmentsThroughThickHazeHaveFiniteLight) {
  const Medium haze = MediumFromToml("preset = \"hazy\"\n[aerosol]\nvisibility_m = 1000\n", "haze");
  const MultipleScatteringOptions few{.altitudes = 8,
                                      .sun_angles = 12,
                                      .degree = 4,
                                      .zenith_nodes = 6,
                                      .azimuth_nodes = 6,
                                      .ray_nodes = 6,
                                      .delta_m = true};
  const MultipleScattering light(haze, few);
  const SingleScattering<float> air(haze);
  for (const double zenith_deg : {0.0, 89.0, 90.0, 91.0}) {
    for (const double sun_zenith_deg : {0.0, 40.0, 89.0, 102.0}) {
      for (const double length_m : {1.0, 5e3, 22e3, 30e3, 1e6}) {
        ViewRay ray = RayFromAngles(2.0, zenith_deg, 20.0, sun_zenith_deg);
        ray.length_m = length_m;
        const auto samples = air.Sample(ray, {.nodes = 12, .dark_samples = true});
        for (const SegmentEnd end : {SegmentEnd::kOpen, SegmentEnd::kOpaque}) {
          const Spectrum more = light.InscatterAlong(samples, ray.nu, end);
          for (std::size_t band = 0; band < more.size(); ++band)
            ASSERT_TRUE(std::isfinite(more[band])) << zenith_deg << " " << length_m;
        }
      }
    }
  }
}

// The ozone behind the last sample is neglected.
TEST(DeltaM, TransmittanceEqualsTheClosedFormUpAndDown) {
  const Medium hazy = MediumPreset("hazy");
  const DeltaM peak(hazy, 6);
  const SingleScattering<float> air(hazy);
  const std::pair<double, double> views[] = {
      {2.0, 95.0}, {100e3, 180.0}, {100e3, 120.0}, {400e3, 120.0}, {400e3, 108.0}};
  for (const auto& [altitude_m, zenith_deg] : views) {
    const ViewRay ray = RayFromAngles(altitude_m, zenith_deg, 60.0, 50.0);
    const auto samples = air.Sample(ray, {.nodes = 12, .dark_samples = true});
    const Spectrum clear = peak.WayTo(samples).clear, truth = air.TransmittanceAlong(ray);
    for (std::size_t band = 0; band < clear.size(); ++band)
      EXPECT_NEAR(clear[band] / truth[band], 1.0F, 1e-3F) << altitude_m << " m, " << zenith_deg;
  }
}

TEST(DeltaM, BeamBelowAltitudeZeroEqualsThatAtAltitudeZero) {
  const ScaledBeam beam(MediumPreset("hazy"), 6);
  for (const double height_m : {-430.0, -10e3})
    EXPECT_EQ(beam.At(height_m, 0.7), beam.At(0.0, 0.7));
}

TEST(OptionsFor, ThinAirWithNarrowLobesTreatsThemSeparately) {
  Medium medium = MediumPreset("earth", {550.0});
  EXPECT_FALSE(OptionsFor(medium).delta_m);
  for (const double g : {0.999, -0.999}) {
    medium.mie_phase = {tests::LobeOf(g)};
    EXPECT_TRUE(OptionsFor(medium).delta_m) << g;
  }
  medium.mie_scattering_per_m = {1e-9};
  EXPECT_FALSE(OptionsFor(medium).delta_m) << "there is hardly any aerosol";
}

TEST(DeltaM, SurvivesARoundTripThroughStoredValues) {
  const Medium haze = Haze(7.992e-5, 8.88e-5);
  const MultipleScatteringOptions few{.altitudes = 8,
                                      .sun_angles = 12,
                                      .degree = 4,
                                      .zenith_nodes = 6,
                                      .azimuth_nodes = 6,
                                      .ray_nodes = 6,
                                      .delta_m = true};
  const MultipleScattering light(haze, few);
  const MultipleScattering back(haze, few, {light.values(), light.orders(), light.converged()});
  const SingleScattering<float> air(haze);
  const ViewRay ray = RayFromAngles(2.0, 60.0, 20.0, 70.0);
  const auto samples = air.Sample(ray, {.nodes = 12, .dark_samples = true});
  EXPECT_EQ(light.InscatterAlong(samples, ray.nu), back.InscatterAlong(samples, ray.nu));
}

// Returns the air of the earth at 550 nm whose aerosol throws light back.
Medium WithBackwardLobe() {
  Medium medium = InScalarLight(MediumPreset("earth", {550.0}));
  medium.mie_phase = {tests::LobeOf(-0.9)};
  medium.mie_extinction_per_m = {0.5 / 1200.0};
  medium.mie_scattering_per_m = {0.97 * 0.5 / 1200.0};
  medium.mie_scale_height_m = 1200.0;
  return medium;
}

// The radiances are those of paths, with standard errors of 0.4 % at the long segments and 1 % at
// the short ones (skylut eval --method path-trace). Directly above the ground, the blurred lobe of
// the moments makes the air half too bright.
TEST(DeltaM, LightOfShortSegmentsTendsToNothing) {
  const Medium medium = WithBackwardLobe();
  const MultipleScattering light(medium, WithFewSuns(OptionsFor(medium)));
  const SingleScattering<float> air(medium);
  ViewRay ray = RayFromAngles(2.0, 52.0, 0.0, 50.0);
  const auto light_of = [&](double length_m) {
    ray.length_m = length_m;
    const auto samples = air.Sample(ray, {.nodes = 20, .split_ozone = true, .dark_samples = true});
    return static_cast<double>(light.InscatterAlong(samples, ray.nu)[0] +
                               air.Inscatter(air.Scatter(samples), ray.nu)[0]);
  };
  EXPECT_NEAR(light_of(1e3), 0.0675934, 0.05 * 0.0676);
  EXPECT_NEAR(light_of(20e3), 0.302777, 0.05 * 0.303);
  EXPECT_NEAR(light_of(10.0), 9.03e-5, 0.7 * 9.03e-5);
  EXPECT_NEAR(light_of(0.1), 7.83e-7, 0.7 * 7.83e-7);
}

// Molecules reach only a hundred metres up, so that their density vanishes in float far below the
// top of the aerosol. Aerosol that is as thin has the same lobe.
TEST(DeltaM, LightOfABackwardLobeIsFiniteAboveAllMolecules) {
  Medium medium = MediumPreset("bruneton2017");
  medium.atmosphere_height_m = 30e3;
  medium.mie_phase = {tests::LobeOf(-0.95)};
  medium.ozone_absorption_per_m.assign(3, 0.0);
  const std::pair<double, double> heights_m[] = {{100.0, 2400.0}, {8000.0, 100.0}, {100.0, 100.0}};
  for (const auto& [of_molecules_m, of_aerosol_m] : heights_m) {
    medium.rayleigh_scale_height_m = of_molecules_m;
    medium.mie_scale_height_m = of_aerosol_m;
    medium.mie_scattering_per_m.assign(3, 0.24 / of_aerosol_m);
    medium.mie_extinction_per_m.assign(3, 0.264 / of_aerosol_m);
    const DeltaM peak(medium, kMaxDegree);
    const SingleScattering<float> air(medium);
    for (const double zenith_deg : {0.0, 50.0, 90.0}) {
      const ViewRay ray = RayFromAngles(2.0, zenith_deg, 0.0, 50.0);
      const auto samples = air.Sample(ray, {.nodes = 20, .dark_samples = true});
      const Spectrum light = peak.Along(samples, ray.nu),
                     error = peak.BackwardError(samples, ray.nu);
      for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_TRUE(std::isfinite(light[band])) << of_molecules_m << " m, " << zenith_deg;
        EXPECT_TRUE(std::isfinite(error[band])) << of_molecules_m << " m, " << zenith_deg;
      }
    }
  }
}

// The column below a point is the difference of columns from the ground and from the point up.
TEST(DeltaM, LightFromBelowComesFromTheColumnBelow) {
  const SingleScattering<float> air(WithBackwardLobe());
  const auto columns_km = [&](double altitude_m) {
    std::array<float, 3> columns = air.ColumnsToSpace(altitude_m, 1.0);
    for (float& column : columns) column *= 1e-3F;
    return columns;
  };
  const std::array<float, 3> ground = columns_km(0.0), above = columns_km(1000.0);
  const AirConstants<float>& constants = air.constants();
  const float rayleigh = std::exp(-1000.0F / (1e3F * constants.rayleigh_height));
  const float mie = std::exp(-1000.0F / (1e3F * constants.mie_height));
  const float gas = ground[0] - above[0], aerosol = ground[1] - above[1];
  const float extinction = constants.rayleigh[0] * gas + constants.mie_extinction[0] * aerosol;
  const float expected =
      -0.5F * std::expm1(-2.0F * extinction) * constants.mie_scattering[0] * aerosol / extinction;
  EXPECT_NEAR(UpFromBelow(constants, 0, 0.0F, {rayleigh, mie, above[0], above[1]}), expected,
              0.02F * expected);
  EXPECT_NEAR(UpFromBelow(constants, 0, 0.0F, {0.0F, mie, 0.0F, above[1]}), expected,
              0.3F * expected)
      << "with a column of molecules that is not known";
}

}  // namespace
}  // namespace alpenglow::lut
