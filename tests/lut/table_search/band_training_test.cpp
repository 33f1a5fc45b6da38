// SPDX-License-Identifier: MIT
#include "tests/fixtures/band_training.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/ray.h"
#include "tests/fixtures/colour_difference.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::lut {
namespace {

using Triple = std::array<double, 3>;

constexpr MultipleScatteringOptions kSmallSolution{.altitudes = tests::ScaledDown(12, 8),
                                                   .sun_angles = tests::ScaledDown(24, 14),
                                                   .degree = 2,
                                                   .zenith_nodes = 5,
                                                   .azimuth_nodes = 4,
                                                   .ray_nodes = 6};

/// Returns the simulator of one air, which is solved once.
const SkySimulator& UsualSimulator() {
  static const SkySimulator simulator(
      {.aerosol_optical_depth_550 = 0.1, .ground_albedo_scale = 2.0}, kSmallSolution);
  return simulator;
}

// No training has seen these skies of three atmospheres, of which one has no haze.
std::vector<SkySpectrum> FreshSkies() {
  SkyDrawing drawing;
  drawing.seed = 20250101;
  drawing.atmospheres = tests::ScaledDown(3, 1);
  drawing.suns = 3;
  drawing.views = 8;
  drawing.multiple_scattering = kSmallSolution;
  return DrawSkySpectra(drawing);
}

// Returns what a renderer gets: radiance in bands, through BandColour, relative to the sun's
// colour.
std::vector<Triple> ColoursThroughBands(const std::vector<double>& wavelengths_nm,
                                        const std::vector<SkySpectrum>& spectra) {
  const std::vector<double> fine = FineWavelengths();
  const BandColour colour(wavelengths_nm);
  std::vector<double> sun;
  for (const double wavelength_nm : wavelengths_nm) sun.push_back(SolarIrradiance(wavelength_nm));
  const Triple white = colour.Xyz(sun);
  std::vector<Triple> colours;
  for (const SkySpectrum& spectrum : spectra) {
    const SampledFunction relative(fine, spectrum.relative_to_sun);
    std::vector<double> radiance = sun;
    for (std::size_t i = 0; i < sun.size(); ++i) radiance[i] *= relative(wavelengths_nm[i]);
    colours.push_back(colour.Xyz(radiance));
    for (std::size_t c = 0; c < 3; ++c) colours.back()[c] /= white[c];
  }
  return colours;
}

struct Bound {
  int bands;
  double mean, percentile95;
};

TEST(BandTraining, DefaultSetsKeepTheColourOfFreshSkies) {
  constexpr Bound kBounds[] = {{3, 0.9, 2.4},  {4, 0.2, 0.6},    {5, 0.08, 0.2},  {6, 0.03, 0.08},
                               {8, 0.03, 0.1}, {16, 0.02, 0.05}, {40, 0.02, 0.05}};
  const std::vector<SkySpectrum> spectra = FreshSkies();
  ASSERT_GT(spectra.size(), tests::ScaledDown(200U, 60U));
  for (const Bound& bound : kBounds) {
    const ColourErrors errors =
        ErrorsOf(ColoursThroughBands(WavelengthSet(bound.bands), spectra), spectra);
    const std::string name = fmt::format("CIEDE2000_of_{}_bands", bound.bands);
    RecordProperty(name, fmt::format("mean {:.3f} p95 {:.3f} max {:.3f}", errors.mean,
                                     errors.percentile95, errors.greatest));
    EXPECT_LT(errors.mean, bound.mean) << name << ", the bound in spectrum.h";
    EXPECT_LT(errors.percentile95, bound.percentile95) << name << ", the bound in spectrum.h";
  }
}

// Returns daylight without tables: sunlight through air and ozone, or scattered by them.
std::vector<SkySpectrum> RoughSkies() {
  std::vector<SkySpectrum> spectra;
  for (const double air : {0.3, 1.0, 3.0, 8.0}) {
    for (const double ozone : {0.3, 2.0, 8.0}) {
      for (const SkyRegime regime : kSkyRegimes) {
        SkySpectrum spectrum{regime, {}};
        for (const double wavelength_nm : FineWavelengths()) {
          const double depth = 8000.0 * RayleighScatteringAtSeaLevel(wavelength_nm);
          const double absorbed = 8e22 * OzoneCrossSection(wavelength_nm);
          const double scattered = regime == SkyRegime::kDirectSun ? 1.0 : 0.02 + depth;
          spectrum.relative_to_sun.push_back(scattered * std::exp(-air * depth - ozone * absorbed));
        }
        spectra.push_back(std::move(spectrum));
      }
    }
  }
  return spectra;
}

TEST(BandTraining, FittedSharesKeepTheColourOfTheSunInSpace) {
  const BandTrainer trainer(RoughSkies());
  for (const auto& set : {std::vector<double>{450.0, 600.0}, {440.0, 500.0, 545.0, 605.0, 650.0}}) {
    for (const std::vector<double>& share : trainer.Fit(set).share) {
      double sum = 0.0;
      for (const double value : share) sum += value;
      EXPECT_NEAR(sum, 1.0, 1e-12) << "a constraint, not a fit";
    }
  }
}

TEST(BandTraining, SearchedSetsAreBetterThanEvenOnes) {
  const std::vector<SkySpectrum> skies = RoughSkies();
  const BandTrainer trainer(skies);
  const std::vector<double> searched = trainer.Search(4, 10);
  EXPECT_TRUE(std::is_sorted(searched.begin(), searched.end(), std::less_equal<>()));
  for (const double wavelength_nm : searched) EXPECT_EQ(std::fmod(wavelength_nm, 10.0), 0.0);
  const ColourErrors found = ErrorsOf(trainer.Fit(searched), skies);
  const ColourErrors even =
      ErrorsOf(trainer.Fit(std::vector<double>{420.0, 500.0, 580.0, 660.0}), skies);
  EXPECT_LT(found.mean, 0.7 * even.mean);
  EXPECT_LT(found.mean, 0.2);
  std::vector<double> all;
  for (double at = 380.0; at < 780.0; at += 10.0) all.push_back(at);
  EXPECT_LT(ErrorsOf(trainer.Fit(all), skies).greatest, 0.01) << "many bands are exact";
  EXPECT_THROW((void)trainer.Fit(std::vector<double>{451.0, 600.0}), InternalError)
      << "off the fine grid";
}

TEST(SkySimulator, SkyIrradianceIsTheIntegralOfRadiance) {
  const SkySimulator& simulator = UsualSimulator();
  for (const double sun_zenith_deg : {50.0, 85.0, 94.0}) {
    const std::vector<double> stored =
        simulator.SkyIrradiance(0.0, std::cos(sun_zenith_deg * kRadiansPerDegree));
    std::vector<double> sum(stored.size(), 0.0);
    constexpr int kAzimuths = tests::ScaledDown(24, 12);
    const GaussRule& rule = GaussLegendre(16);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double mu = rule.node[i];
      for (int k = 0; k < kAzimuths; ++k) {
        const std::vector<double> radiance = simulator.Radiance(RayFromAngles(
            0.0, std::acos(mu) / kRadiansPerDegree, 180.0 * (k + 0.5) / kAzimuths, sun_zenith_deg));
        for (std::size_t band = 0; band < sum.size(); ++band) {
          sum[band] += rule.weight[i] * 2.0 * kPi / kAzimuths * mu * radiance[band];
        }
      }
    }
    for (std::size_t band = 0; band < sum.size(); band += 8) {
      EXPECT_NEAR(stored[band] / sum[band], 1.0, 0.05)
          << sun_zenith_deg << " " << band << ": a table of few nodes";
    }
  }
}

TEST(SkySimulator, LandWithoutAirHasTheRadianceOfItsAlbedo) {
  const SkySimulator& simulator = UsualSimulator();
  ViewRay down = RayFromAngles(1.0, 180.0, 0.0, 60.0);
  down.length_m = 1.0;
  const std::vector<double> seen = simulator.Radiance(down);
  const std::vector<double> sky = simulator.SkyIrradiance(0.0, 0.5);
  const std::vector<double> sun = simulator.SunIrradiance(0.0, 0.5);
  const double albedo = 2.0 * 0.125;  // the preset's at 550 nm
  EXPECT_NEAR(seen[34], albedo / kPi * (sky[34] + 0.5 * sun[34]), 1e-3 * seen[34])
      << "550 nm, through 1 m of air";
}

TEST(SkySpectra, AreReproducibleAndOfEveryRegime) {
  SkyDrawing drawing;
  drawing.atmospheres = 1;
  drawing.suns = 1;
  drawing.views = 2;
  drawing.multiple_scattering = kSmallSolution;
  const std::vector<SkySpectrum> first = DrawSkySpectra(drawing);
  const std::vector<SkySpectrum> second = DrawSkySpectra(drawing);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].relative_to_sun, second[i].relative_to_sun);
  }
  for (const SkyRegime regime : kSkyRegimes) EXPECT_FALSE(OfRegime(regime, first).empty());
}

// Compares paper of many colours under one light, through bands and by fine spectra.
ColourErrors SurfaceErrors(int bands, const std::vector<double>& light) {
  const std::vector<double> fine = FineWavelengths();
  const std::vector<double> set = WavelengthSet(bands);
  const SampledFunction light_at(fine, light);
  const BandColour colour(set);
  std::vector<double> sun;
  for (const double wavelength_nm : set) sun.push_back(SolarIrradiance(wavelength_nm));
  const Triple white = colour.Xyz(sun);
  const Triple paper = RelativeXyz(light);
  ColourErrors errors;
  for (int i = 0; i < 27; ++i) {
    constexpr double kLevels[] = {0.1, 0.3, 0.6};
    const Triple rgb{kLevels[i % 3], kLevels[i / 3 % 3], kLevels[i / 9]};
    std::vector<double> exact = AlbedoFromLinearSrgb(rgb, fine);
    for (std::size_t j = 0; j < exact.size(); ++j) exact[j] *= light[j];
    std::vector<double> radiance = AlbedoFromLinearSrgb(rgb, set);
    for (std::size_t j = 0; j < set.size(); ++j) radiance[j] *= sun[j] * light_at(set[j]);
    Triple through = colour.Xyz(radiance);
    for (std::size_t c = 0; c < 3; ++c) through[c] /= white[c];
    const double error = tests::Ciede2000(through, RelativeXyz(exact), paper);
    errors.mean += error / 27.0;
    errors.greatest = std::max(errors.greatest, error);
  }
  return errors;
}

std::vector<double> Daylight(double sun_elevation_deg) {
  const SkySimulator& simulator = UsualSimulator();
  const double mu_s = std::sin(sun_elevation_deg * kRadiansPerDegree);
  std::vector<double> light = simulator.SkyIrradiance(2.0, mu_s);
  const std::vector<double> sun = simulator.SunIrradiance(2.0, mu_s);
  for (std::size_t i = 0; i < light.size(); ++i) light[i] += std::max(0.0, mu_s) * sun[i];
  return light;
}

TEST(Albedo, KeepsItsColourThroughBandsUnderDaylight) {
  constexpr Bound kBounds[] = {{3, 0.5, 1.0}, {4, 0.3, 0.6},  {5, 0.2, 0.4}, {6, 0.1, 0.2},
                               {8, 0.1, 0.2}, {16, 0.1, 0.2}, {40, 0.1, 0.2}};
  const std::vector<double> daylight = Daylight(30.0);
  for (const Bound& bound : kBounds) {
    const ColourErrors errors = SurfaceErrors(bound.bands, daylight);
    RecordProperty(fmt::format("CIEDE2000_of_surfaces_in_{}_bands", bound.bands),
                   fmt::format("mean {:.3f} max {:.3f}", errors.mean, errors.greatest));
    EXPECT_LT(errors.mean, bound.mean) << bound.bands << " bands, the bound in spectrum.h";
    EXPECT_LT(errors.greatest, bound.percentile95) << bound.bands << " bands";
  }
}

TEST(Albedo, KeepsItsColourThroughFourBandsAtSunsetAndInTwilight) {
  EXPECT_LT(SurfaceErrors(4, Daylight(4.0)).mean, 0.8) << "0.5 is measured";
  EXPECT_LT(SurfaceErrors(4, Daylight(-3.0)).mean, 2.0) << "1.3 is measured";
}

}  // namespace
}  // namespace alpenglow::lut
