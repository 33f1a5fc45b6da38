// SPDX-License-Identifier: MIT
// Published tables and the formulas on them. Colour is in colour.cpp and band_colour.cpp.
#include "atmosphere/colour/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "atmosphere/colour/solar_table.h"
#include "atmosphere/colour/trained_bands.h"
#include "atmosphere/text/embedded_table.h"
#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

// Column `column` over column 0 of an embedded table.
SampledFunction ReadTable(std::string_view file, int column, double shift_x = 0.0) {
  std::vector<std::vector<double>> columns = atmosphere::ReadColumns(file, {0, column});
  for (double& x : columns[0]) x += shift_x;
  return {std::move(columns[0]), std::move(columns[1])};
}

constexpr std::string_view kSolarFile = "atmosphere/data/solar_irradiance_astm_g173_etr_native.csv";
constexpr std::string_view kOzoneFile = "atmosphere/data/ozone_cross_section_10nm.csv";
constexpr std::string_view kScotopicFile = "atmosphere/data/scotopic_1951_10nm.csv";
constexpr std::string_view kObserverFile = "atmosphere/data/cie1931_2deg_cmf_5nm.csv";

double ValueInside(const SampledFunction& table, double low, double high, double x) {
  return x >= low && x <= high ? table(x) : 0.0;
}

std::vector<double> UniformSet(double first_nm, double step_nm, int count) {
  std::vector<double> wavelengths_nm;
  for (int i = 0; i < count; ++i) wavelengths_nm.push_back(first_nm + step_nm * i);
  return wavelengths_nm;
}

}  // namespace

SampledFunction::SampledFunction(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)) {
  ALPENGLOW_ENSURE(x_.size(), ==, y_.size());
  ALPENGLOW_ENSURE(x_.size(), >, std::size_t{0});
  for (std::size_t i = 1; i < x_.size(); ++i) ALPENGLOW_ENSURE(x_[i - 1], <, x_[i]);
}

double SampledFunction::operator()(double x) const {
  const auto above = std::upper_bound(x_.begin(), x_.end(), x);
  if (above == x_.begin()) return y_.front();
  if (above == x_.end()) return y_.back();
  const auto i = static_cast<std::size_t>(above - x_.begin());
  const double share = (x - x_[i - 1]) / (x_[i] - x_[i - 1]);
  return y_[i - 1] + share * (y_[i] - y_[i - 1]);
}

double SampledFunction::Mean(double low, double high) const {
  ALPENGLOW_ENSURE(low, <, high);
  double area = 0.0;
  double from = low;
  double value_from = (*this)(low);
  for (auto next = std::upper_bound(x_.begin(), x_.end(), low); from < high; ++next) {
    const double to = next == x_.end() ? high : std::min(*next, high);
    const double value_to = (*this)(to);
    area += 0.5 * (value_from + value_to) * (to - from);
    from = to;
    value_from = value_to;
    if (next == x_.end()) break;
  }
  return area / (high - low);
}

std::vector<double> WavelengthSet(int bands) {
  if (bands == 8) return UniformSet(400.0, 40.0, 8);
  if (bands == 16) return UniformSet(390.0, 20.0, 16);
  if (bands == 40) return UniformSet(380.0, 10.0, 40);
  for (const TrainedBands& set : TrainedBandSets()) {
    if (static_cast<int>(set.wavelengths_nm.size()) == bands) return set.wavelengths_nm;
  }
  throw InputError(fmt::format("bands is {}; it must be one of {}", bands,
                               fmt::join(kWavelengthSetSizes, ", ")));
}

const SampledFunction& SolarTable() {
  static const SampledFunction table = ReadTable(kSolarFile, 1);
  return table;
}

double SolarIrradiance(double wavelength_nm) {
  const SampledFunction& table = SolarTable();
  const double centre = std::clamp(wavelength_nm, table.x().front(), table.x().back());
  return table.Mean(centre - 5.0, centre + 5.0);
}

double RayleighScatteringAtSeaLevel(double wavelength_nm) {
  RequireInRange(wavelength_nm, 250.0, 4000.0, "wavelength_nm");
  constexpr double kMoleculesPerCubicMetre = 2.546899e25;  // 288.15 K, 1013.25 hPa
  const double um2 = wavelength_nm * wavelength_nm * 1e-6;
  const double cross_section_m2 = 1e-32 * (1.0455996 - 341.29061 / um2 - 0.90230850 * um2) /
                                  (1.0 + 0.0027059889 / um2 - 85.968563 * um2);
  return kMoleculesPerCubicMetre * cross_section_m2;
}

double OzoneCrossSection(double wavelength_nm) {
  // The table holds means over [x, x + 10) nm: they belong to x + 5.
  static const SampledFunction table = ReadTable(kOzoneFile, 1, 5.0);
  return ValueInside(table, 360.0, 840.0, wavelength_nm);
}

std::array<double, 3> ColourMatching(double wavelength_nm) {
  static const std::array<SampledFunction, 3> tables{
      ReadTable(kObserverFile, 1), ReadTable(kObserverFile, 2), ReadTable(kObserverFile, 3)};
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < 3; ++i) xyz[i] = ValueInside(tables[i], 360.0, 830.0, wavelength_nm);
  return xyz;
}

double ScotopicEfficiency(double wavelength_nm) {
  static const SampledFunction table = ReadTable(kScotopicFile, 1);
  return ValueInside(table, 380.0, 780.0, wavelength_nm);
}

}  // namespace alpenglow::atmosphere
