// SPDX-License-Identifier: MIT
// Implements published tables and the formulas based on them, sRGB, colour differences, and albedos
// from colours. The conversion from bands to colour is in band_colour.cpp.
#include "atmosphere/colour/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/band_colour.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

// Returns column `column` of an embedded table as a function of column 0.
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

SampledFunction Column(int column) {
  auto columns = atmosphere::ReadColumns("atmosphere/data/water_and_ice_10nm.csv", {0, column});
  return {std::move(columns[0]), std::move(columns[1])};
}

using Triple = std::array<double, 3>;

Triple Cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The columns of the inverse are the cross products of the rows, divided by the determinant.
Matrix3 Inverse(const Matrix3& m) {
  const Triple columns[3] = {Cross(m[1], m[2]), Cross(m[2], m[0]), Cross(m[0], m[1])};
  const double determinant =
      m[0][0] * columns[0][0] + m[0][1] * columns[0][1] + m[0][2] * columns[0][2];
  Matrix3 inverse{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      inverse[row][column] = columns[column][row] / determinant;
    }
  }
  return inverse;
}

Triple XyzFromChromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

const Triple& WhiteD65() {
  static const Triple white = XyzFromChromaticity(0.3127, 0.3290);
  return white;
}

// The columns are the primaries, scaled so that (1, 1, 1) is the white point.
Matrix3 DeriveXyzFromLinearSrgb() {
  const Triple primaries[3] = {XyzFromChromaticity(0.64, 0.33), XyzFromChromaticity(0.30, 0.60),
                               XyzFromChromaticity(0.15, 0.06)};
  Matrix3 matrix{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) matrix[row][column] = primaries[column][row];
  }
  const Triple scale = Inverse(matrix) * WhiteD65();
  for (Triple& row : matrix) {
    for (std::size_t column = 0; column < 3; ++column) row[column] *= scale[column];
  }
  return matrix;
}

double Step(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// Returns the reflectances of a red, a green and a blue surface that add up to 1: smooth steps at
// 485 and 593 nm, placed so that their colours are near the primaries of sRGB, within 0.05.
Triple AlbedoBases(double wavelength_nm) {
  constexpr double kBlueEnd_nm = 485.0;
  constexpr double kRedStart_nm = 593.0;
  constexpr double kWidth_nm = 8.0;
  const double red = Step((wavelength_nm - kRedStart_nm) / kWidth_nm);
  const double blue = Step((kBlueEnd_nm - wavelength_nm) / kWidth_nm);
  return {red, 1.0 - red - blue, blue};
}

// Returns the matrix from linear sRGB to weights of the bases: the inverse of the bases' colours
// under equal-energy light, whose white is scaled to D65 component by component.
Matrix3 DeriveSharesFromLinearSrgb() {
  Matrix3 xyz{};
  for (double wavelength_nm = 360.0; wavelength_nm <= 830.0; wavelength_nm += 1.0) {
    const Triple bases = AlbedoBases(wavelength_nm);
    const Triple matching = ColourMatching(wavelength_nm);
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t base = 0; base < 3; ++base) xyz[row][base] += matching[row] * bases[base];
    }
  }
  for (std::size_t row = 0; row < 3; ++row) {
    const double white = xyz[row][0] + xyz[row][1] + xyz[row][2];
    for (double& value : xyz[row]) value *= WhiteD65()[row] / white;
  }
  Matrix3 srgb{};
  for (std::size_t base = 0; base < 3; ++base) {
    const Triple colour = LinearSrgbFromXyz() * Triple{xyz[0][base], xyz[1][base], xyz[2][base]};
    for (std::size_t row = 0; row < 3; ++row) srgb[row][base] = colour[row];
  }
  return Inverse(srgb);
}

// Returns the colours of the bases under the sun above the air, relative to the sun's colour: one
// row per basis.
Matrix3 DeriveBasesUnderSun() {
  constexpr double kStep_nm = 0.5;
  Matrix3 xyz{};
  Triple sun{};
  for (double at = 360.0 + 0.5 * kStep_nm; at < 830.0; at += kStep_nm) {
    const Triple bases = AlbedoBases(at);
    const Triple matching = ColourMatching(at);
    for (std::size_t c = 0; c < 3; ++c) {
      sun[c] += matching[c] * SolarTable()(at);
      for (std::size_t base = 0; base < 3; ++base) {
        xyz[base][c] += matching[c] * SolarTable()(at) * bases[base];
      }
    }
  }
  for (Triple& row : xyz) {
    for (std::size_t c = 0; c < 3; ++c) row[c] /= sun[c];
  }
  return xyz;
}

// Returns the bases at the bands of a trained set, with the smallest change that gives them the
// above colours through the bands: with the weights M and the error e of a basis, the change is
// M^T (M M^T)^-1 e.
std::vector<Triple> AlbedoBasesInBands(const TrainedBands& set) {
  static const Matrix3 under_sun = DeriveBasesUnderSun();
  const std::size_t n = set.wavelengths_nm.size();
  std::vector<Triple> bases;
  for (const double wavelength_nm : set.wavelengths_nm) bases.push_back(AlbedoBases(wavelength_nm));
  Matrix3 product{};
  Matrix3 error = under_sun;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) {
        product[c][d] += set.share[c][i] * set.share[d][i];
        error[c][d] -= bases[i][c] * set.share[d][i];
      }
    }
  }
  const Matrix3 inverse = Inverse(product);
  for (std::size_t base = 0; base < 3; ++base) {
    const Triple multiplier = inverse * error[base];
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < 3; ++c) bases[i][base] += multiplier[c] * set.share[c][i];
    }
  }
  return bases;
}

std::vector<Triple> AlbedoBasesAt(std::span<const double> wavelengths_nm) {
  if (const TrainedBands* set = FindTrainedBands(wavelengths_nm)) return AlbedoBasesInBands(*set);
  std::vector<Triple> bases;
  for (const double wavelength_nm : wavelengths_nm) bases.push_back(AlbedoBases(wavelength_nm));
  return bases;
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
  // The table holds means over [x, x + 10) nm, so their wavelength is x + 5.
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

double BlackBodyRadiance(double wavelength_nm, double temperature_k) {
  constexpr double kC1_w_m2_per_sr = 1.191042972397188e-16;  // 2 h c^2
  constexpr double kC2_m_k = 1.438776877503933e-2;           // h c / k
  const double metres = 1e-9 * wavelength_nm;
  const double per_metre =
      kC1_w_m2_per_sr / std::pow(metres, 5.0) / std::expm1(kC2_m_k / (metres * temperature_k));
  return 1e-9 * per_metre;
}

double WaterAbsorption(double wavelength_nm) {
  static const SampledFunction table = Column(1);
  return table(wavelength_nm);
}

double SeaWaterScattering(double wavelength_nm) {
  return 0.00288 * std::pow(wavelength_nm / 500.0, -4.32);
}

double IceAbsorption(double wavelength_nm) {
  static const SampledFunction table = Column(2);
  return 4.0 * kPi * table(wavelength_nm) / (1e-9 * wavelength_nm);
}

const Matrix3& XyzFromLinearSrgb() {
  static const Matrix3 matrix = DeriveXyzFromLinearSrgb();
  return matrix;
}

const Matrix3& LinearSrgbFromXyz() {
  static const Matrix3 matrix = Inverse(XyzFromLinearSrgb());
  return matrix;
}

std::array<double, 3> operator*(const Matrix3& matrix, const std::array<double, 3>& vector) {
  Triple product{};
  for (std::size_t row = 0; row < 3; ++row) {
    product[row] =
        matrix[row][0] * vector[0] + matrix[row][1] * vector[1] + matrix[row][2] * vector[2];
  }
  return product;
}

std::vector<double> AlbedoFromLinearSrgb(const std::array<double, 3>& rgb,
                                         std::span<const double> wavelengths_nm) {
  static const Matrix3 shares_from_srgb = DeriveSharesFromLinearSrgb();
  Triple shares = shares_from_srgb * rgb;
  for (double& share : shares) share = std::clamp(share, 0.0, 1.0);
  std::vector<double> albedo;
  for (const Triple& bases : AlbedoBasesAt(wavelengths_nm)) {
    albedo.push_back(
        std::clamp(shares[0] * bases[0] + shares[1] * bases[1] + shares[2] * bases[2], 0.0, 1.0));
  }
  return albedo;
}

}  // namespace alpenglow::atmosphere
