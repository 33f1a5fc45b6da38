// SPDX-License-Identifier: MIT
#include "atmosphere/air/medium_bands.h"

#include <algorithm>
#include <array>
#include <string>

#include "atmosphere/colour/spectrum.h"

namespace alpenglow::atmosphere {
namespace {

using Row = std::vector<double> Medium::*;

constexpr std::array<Row, 6> kRows{
    &Medium::solar_irradiance,          &Medium::ground_albedo,
    &Medium::rayleigh_scattering_per_m, &Medium::mie_scattering_per_m,
    &Medium::mie_extinction_per_m,      &Medium::ozone_absorption_per_m};

/// The preset in a medium's name, if it has values at all wavelengths of the table's data.
std::optional<std::string> PresetOf(const Medium& medium) {
  for (const std::string& preset : MediumPresetNames()) {
    if (preset == "bruneton2017") continue;
    if (medium.name == preset || medium.name == "custom (from " + preset + ")") return preset;
  }
  return std::nullopt;
}

/// Linear between wavelengths, constant beyond them.
double Interpolated(const std::vector<double>& nm, const std::vector<double>& values, double at) {
  const auto above = std::upper_bound(nm.begin(), nm.end(), at);
  if (above == nm.begin()) return values.front();
  if (above == nm.end()) return values.back();
  const auto i = static_cast<std::size_t>(above - nm.begin());
  const double share = (at - nm[i - 1]) / (nm[i] - nm[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

/// Factor by which a medium differs from its preset; nothing where that is none.
std::optional<std::vector<double>> Factors(const std::vector<double>& medium,
                                           const std::vector<double>& preset) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < medium.size(); ++i) {
    if (preset[i] == 0.0 && medium[i] != 0.0) return std::nullopt;
    factors.push_back(preset[i] == 0.0 ? 1.0 : medium[i] / preset[i]);
  }
  return factors;
}

/// The gas's own where the medium has that.
std::vector<double> DepolarisationAt(const Medium& medium, const std::string& preset,
                                     const std::vector<double>& wavelengths_nm) {
  const std::vector<double>& here = medium.rayleigh_depolarisation;
  if (here == GasDepolarisation(preset, medium.wavelengths_nm))
    return GasDepolarisation(preset, wavelengths_nm);
  std::vector<double> there;
  for (const double nm : wavelengths_nm)
    there.push_back(Interpolated(medium.wavelengths_nm, here, nm));
  return there;
}

}  // namespace

std::optional<Medium> OnBands(const Medium& medium, int bands) {
  const std::optional<std::string> name = PresetOf(medium);
  if (!name || medium.wavelengths_nm.front() < kFirstPresetWavelength_nm ||
      medium.wavelengths_nm.back() > kLastPresetWavelength_nm) {
    return std::nullopt;
  }
  const Medium here = MediumPreset(*name, medium.wavelengths_nm);
  const Medium there = MediumPreset(*name, WavelengthSet(bands));
  if (medium.mie_phase != here.mie_phase && medium.mie_phase.size() > 1) return std::nullopt;
  Medium result = medium;
  result.wavelengths_nm = there.wavelengths_nm;
  if (medium.mie_phase == here.mie_phase) result.mie_phase = there.mie_phase;
  if (result.rayleigh_depolarisation.size() > 1) {
    result.rayleigh_depolarisation = DepolarisationAt(medium, *name, there.wavelengths_nm);
  }
  for (const Row row : kRows) {
    const auto factors = Factors(medium.*row, here.*row);
    if (!factors) return std::nullopt;
    result.*row = there.*row;
    for (std::size_t i = 0; i < there.wavelengths_nm.size(); ++i) {
      (result.*row)[i] *= Interpolated(medium.wavelengths_nm, *factors, there.wavelengths_nm[i]);
    }
  }
  return result;
}

}  // namespace alpenglow::atmosphere
