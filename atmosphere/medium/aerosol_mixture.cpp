// SPDX-License-Identifier: MIT
#include "atmosphere/medium/aerosol_mixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/phase_table.h"

namespace alpenglow::atmosphere {
namespace {

constexpr std::string_view kOpticsFile = "atmosphere/data/opac_aerosol_80rh.csv";
constexpr std::string_view kPhaseFile = "atmosphere/data/opac_phase_80rh.csv";

struct Mixture {
  std::string name;
  double opac_scale_height_m = 0.0;
  std::vector<double> wavelength_nm, extinction_per_m, albedo, mean_cosine;
  SpectralPhase phase;  // empty when OPAC's phase function is not in the tables
};

// Tops of the mixing layers [m]: OPAC's Table 5.
double TopOfMixingLayer(std::string_view name) {
  if (name == "desert") return 6000.0;
  if (name == "antarctic") return 10000.0;
  return 2000.0;
}

/// Water-soluble, insoluble and soot particles [1/cm^3] of continental aerosol: OPAC's Table 3.
struct ContinentalParticles {
  const char* mixture;
  std::array<double, 3> number;
};
constexpr std::array<ContinentalParticles, 3> kTabulated{{
    {"continental_clean", {2600.0, 0.15, 0.0}},
    {"continental_average", {7000.0, 0.4, 8300.0}},
    {"urban", {28000.0, 1.5, 130000.0}},
}};
constexpr ContinentalParticles kPolluted{"continental_polluted", {15700.0, 0.6, 34300.0}};

double Determinant(const std::array<double, 3>& a, const std::array<double, 3>& b,
                   const std::array<double, 3>& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
         c[0] * (a[1] * b[2] - a[2] * b[1]);
}

// Returns the multiples of the tabulated mixtures that add up to the particles of the polluted
// mixture, by Cramer's rule.
std::array<double, 3> SharesOfPolluted() {
  std::array<std::array<double, 3>, 3> column{};
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = kTabulated[i].number;
  const double whole = Determinant(column[0], column[1], column[2]);
  std::array<double, 3> share{};
  for (std::size_t i = 0; i < share.size(); ++i) {
    auto replaced = column;
    replaced[i] = kPolluted.number;
    share[i] = Determinant(replaced[0], replaced[1], replaced[2]) / whole;
  }
  return share;
}

Mixture& Named(std::vector<Mixture>& mixtures, std::string_view name) {
  return *std::find_if(mixtures.begin(), mixtures.end(),
                       [&](const Mixture& mixture) { return mixture.name == name; });
}

// The polluted mixture has no phase function in the tables, but it consists of the particles of
// three mixtures that have one, and scattering coefficient times phase function is additive. The
// result agrees within 0.1 % with the scattering and the mean cosine in the tables; the deviation
// is the magnified rounding of their last digits.
void AddPollutedPhase(std::vector<Mixture>& mixtures) {
  const std::array<double, 3> share = SharesOfPolluted();
  SpectralPhase phase = Named(mixtures, kTabulated[0].mixture).phase;
  for (std::size_t w = 0; w < phase.wavelength_nm.size(); ++w) {
    std::vector<double>& per_sr = phase.per_sr[w];
    std::vector<double> light(per_sr.size());
    double scattering = 0.0;
    for (std::size_t i = 0; i < share.size(); ++i) {
      const Mixture& part = Named(mixtures, kTabulated[i].mixture);
      const SampledFunction extinction(part.wavelength_nm, part.extinction_per_m);
      const SampledFunction albedo(part.wavelength_nm, part.albedo);
      const double nm = phase.wavelength_nm[w];
      const double per_m = share[i] * extinction(nm) * albedo(nm);
      scattering += per_m;
      for (std::size_t k = 0; k < light.size(); ++k) light[k] += per_m * part.phase.per_sr[w][k];
    }
    for (std::size_t k = 0; k < light.size(); ++k) per_sr[k] = light[k] / scattering;
  }
  Named(mixtures, kPolluted.mixture).phase = std::move(phase);
}

void AddPhases(std::vector<Mixture>& mixtures) {
  const std::vector<std::string> names = atmosphere::ReadTextColumn(kPhaseFile, 0);
  const auto columns = atmosphere::ReadColumns(kPhaseFile, {1, 2, 3});
  for (Mixture& mixture : mixtures) {
    const auto begin = std::find(names.begin(), names.end(), mixture.name) - names.begin();
    const auto count = static_cast<std::size_t>(
        std::count(names.begin(), names.end(), mixture.name));  // rows of a mixture are contiguous
    const auto rows = [&](std::size_t column) {
      return std::span(columns[column]).subspan(static_cast<std::size_t>(begin), count);
    };
    mixture.phase = SpectralPhaseFromRows(rows(0), rows(1), rows(2));
  }
  AddPollutedPhase(mixtures);
}

std::vector<Mixture> ReadMixtures() {
  const std::vector<std::string> names = atmosphere::ReadTextColumn(kOpticsFile, 0);
  const auto columns = atmosphere::ReadColumns(kOpticsFile, {1, 2, 3, 5, 6});
  std::vector<Mixture> mixtures;
  for (std::size_t row = 0; row < names.size(); ++row) {
    if (mixtures.empty() || mixtures.back().name != names[row]) {
      mixtures.emplace_back();
      mixtures.back().name = names[row];
      mixtures.back().opac_scale_height_m = 1000.0 * columns[0][row];
    }
    Mixture& mixture = mixtures.back();
    mixture.wavelength_nm.push_back(columns[1][row]);
    mixture.extinction_per_m.push_back(columns[2][row] / 1000.0);
    mixture.albedo.push_back(columns[3][row]);
    mixture.mean_cosine.push_back(columns[4][row]);
  }
  AddPhases(mixtures);
  return mixtures;
}

const std::vector<Mixture>& Mixtures() {
  static const std::vector<Mixture> mixtures = ReadMixtures();
  return mixtures;
}

const Mixture& FindMixture(std::string_view name) {
  for (const Mixture& mixture : Mixtures()) {
    if (mixture.name == name) return mixture;
  }
  throw InputError(fmt::format("mixture is \"{}\"; it must be one of {}", name,
                               fmt::join(AerosolMixtureNames(), ", ")));
}

// Interpolates by a power law between neighbours. Beyond the ends the power law of the nearest two
// points is continued.
double PowerLaw(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  const auto i = static_cast<std::size_t>(above - x.begin());
  return y[i - 1] * std::pow(y[i] / y[i - 1], std::log(at / x[i - 1]) / std::log(x[i] / x[i - 1]));
}

std::vector<PhaseFunction> PhasesOf(const Mixture& mixture,
                                    const std::vector<double>& wavelengths_nm) {
  std::vector<PhaseFunction> phases;
  for (const double wavelength_nm : wavelengths_nm) {
    if (!mixture.phase.wavelength_nm.empty()) {
      phases.push_back(
          {.kind = PhaseKind::kTable,
           .table = std::make_shared<const PhaseTable>(mixture.phase.At(wavelength_nm))});
    } else {
      const SampledFunction mean_cosine(mixture.wavelength_nm, mixture.mean_cosine);
      phases.push_back(
          {.kind = PhaseKind::kCornetteShanks, .g = CornetteShanksG(mean_cosine(wavelength_nm))});
    }
  }
  return phases;
}

}  // namespace

std::vector<std::string> AerosolMixtureNames() {
  std::vector<std::string> names;
  for (const Mixture& mixture : Mixtures()) names.push_back(mixture.name);
  return names;
}

AerosolOptics AerosolMixture(std::string_view name, const std::vector<double>& wavelengths_nm) {
  const Mixture& mixture = FindMixture(name);
  const SampledFunction albedo(mixture.wavelength_nm, mixture.albedo);
  const double z = mixture.opac_scale_height_m;
  AerosolOptics optics;
  optics.scale_height_m = -z * std::expm1(-TopOfMixingLayer(name) / z);
  optics.extinction_550_per_m = PowerLaw(mixture.wavelength_nm, mixture.extinction_per_m, 550.0);
  for (const double wavelength_nm : wavelengths_nm) {
    const double extinction =
        PowerLaw(mixture.wavelength_nm, mixture.extinction_per_m, wavelength_nm);
    optics.extinction_per_m.push_back(extinction);
    optics.scattering_per_m.push_back(extinction * albedo(wavelength_nm));
  }
  optics.phase = PhasesOf(mixture, wavelengths_nm);
  return optics;
}

std::vector<PhaseFunction> AerosolMixturePhase(std::string_view name,
                                               const std::vector<double>& wavelengths_nm) {
  return PhasesOf(FindMixture(name), wavelengths_nm);
}

double CornetteShanksG(double mean_cosine) {
  // 3 g (4 + g^2) / (5 (2 + g^2)) increases with g, with a slope of at least 0.9.
  double low = 0.0, high = 1.0;
  while (high - low > 1e-12) {
    const double g = 0.5 * (low + high);
    (3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g)) < mean_cosine ? low : high) = g;
  }
  return 0.5 * (low + high);
}

}  // namespace alpenglow::atmosphere
