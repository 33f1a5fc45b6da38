// SPDX-License-Identifier: MIT
// Trains the sets of bands and their colour matrices on simulated skies, and measures their errors
// on other skies. It prints atmosphere/data/band_matrices.csv:
//
//   train_bands > atmosphere/data/band_matrices.csv
//
// This takes a minute on two cores. Run it again when the solar spectrum, the cross sections or the
// kind of aerosol change, then change the checksum in tests/atmosphere/colour/spectrum_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "tests/fixtures/band_training.h"

namespace alpenglow::lut {
namespace {

struct Options {
  SkyDrawing training;
  int tested_atmospheres = 12;
  int step_nm = 5;
};

void AddRange(CLI::App& app, const std::string& name, double& low, double& high,
              const std::string& what) {
  app.add_option(name + "-low", low, what + ", lowest")->capture_default_str();
  app.add_option(name + "-high", high, what + ", highest")->capture_default_str();
}

void AddOptions(CLI::App& app, Options& options) {
  SkyFamily& family = options.training.family;
  app.add_option("--preset", family.preset, "Atmosphere whose aerosol and ozone are varied")
      ->capture_default_str();
  AddRange(app, "--optical-depth", family.optical_depth_low, family.optical_depth_high,
           "Aerosol optical depth at 550 nm");
  AddRange(app, "--angstrom", family.angstrom_low, family.angstrom_high, "Angstrom exponent");
  AddRange(app, "--ozone", family.ozone_low_dobson, family.ozone_high_dobson, "Ozone [DU]");
  app.add_option("--atmospheres", options.training.atmospheres, "To train on")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--tested-atmospheres", options.tested_atmospheres, "To measure on")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", options.training.seed, "Of the training; the test has the next one")
      ->capture_default_str();
  app.add_option("--step", options.step_nm, "Spacing of the wavelengths tried [nm]: 5 or 10")
      ->check(CLI::IsMember({5, 10}))
      ->capture_default_str();
}

std::string Text(const ColourErrors& errors) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", errors.mean, errors.percentile95, errors.greatest);
}

void PrintErrors(const BandShares& bands, const std::vector<SkySpectrum>& spectra) {
  fmt::print("# {} bands: all {}", bands.wavelengths_nm.size(), Text(ErrorsOf(bands, spectra)));
  for (const SkyRegime regime : kSkyRegimes) {
    fmt::print("; {} {}", NameOf(regime), Text(ErrorsOf(bands, OfRegime(regime, spectra))));
  }
  fmt::print("\n");
}

void PrintMatrix(const BandShares& bands) {
  for (std::size_t i = 0; i < bands.wavelengths_nm.size(); ++i) {
    fmt::print("{},{:.0f},{:.7f},{:.7f},{:.7f}\n", bands.wavelengths_nm.size(),
               bands.wavelengths_nm[i], bands.share[0][i], bands.share[1][i], bands.share[2][i]);
  }
}

std::vector<BandShares> Train(const Options& options, const std::vector<SkySpectrum>& spectra) {
  const BandTrainer trainer(spectra);
  std::vector<BandShares> sets;
  for (const int bands : kWavelengthSetSizes) {
    sets.push_back(
        trainer.Fit(bands <= 6 ? trainer.Search(bands, options.step_nm) : WavelengthSet(bands)));
  }
  return sets;
}

void Run(const Options& options, const std::string& command) {
  SkyDrawing testing = options.training;
  testing.seed += 1;
  testing.atmospheres = options.tested_atmospheres;
  const std::vector<SkySpectrum> training_spectra = DrawSkySpectra(options.training);
  const std::vector<SkySpectrum> test_spectra = DrawSkySpectra(testing);
  const std::vector<BandShares> sets = Train(options, training_spectra);
  fmt::print(
      "# Colour of light in bands, relative to the sun above the air: X / X(sun) is the sum of "
      "x_share times radiance over solar irradiance, over the bands; Y and Z likewise.\n"
      "# Made by: {}\n"
      "# Trained on {} spectra of {} atmospheres. CIEDE2000 (mean, 95th percentile, greatest) at "
      "equal exposure on {} spectra of {} others, against {} wavelengths:\n",
      command, training_spectra.size(), options.training.atmospheres, test_spectra.size(),
      options.tested_atmospheres, FineWavelengths().size());
  for (const BandShares& bands : sets) PrintErrors(bands, test_spectra);
  fmt::print("bands,wavelength_nm,x_share,y_share,z_share\n");
  for (const BandShares& bands : sets) PrintMatrix(bands);
}

}  // namespace
}  // namespace alpenglow::lut

int main(int argc, char** argv) {
  alpenglow::lut::Options options;
  CLI::App app("Trains wavelengths and colour matrices of bands on simulated skies");
  alpenglow::lut::AddOptions(app, options);
  CLI11_PARSE(app, argc, argv);
  std::string command = "train_bands";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  try {
    alpenglow::lut::Run(options, command);
  } catch (const alpenglow::lut::InputError& error) {
    fmt::print(stderr, "train_bands: {}\n", error.what());
    return 3;
  }
  return 0;
}
