// SPDX-License-Identifier: MIT
// Computes colour from radiance in bands.
//
// With radiance L(lambda) = E(lambda) f(lambda), where E is the solar irradiance above the air, f
// is smooth although E is not. The initial matrix assumes that f is linear between the bands and
// constant beyond the outermost,
//
//   XYZ_c = sum a_ci f_i,    a_ci = K integral of  cmf_c(lambda) E(lambda) hat_i(lambda)  d lambda,
//
// which is exact for the sun itself on any wavelength set: its white point never moves. With at
// most sixteen bands a correction is added that minimises the relative errors of XYZ over a family
// of daylight spectra. The correction keeps the sun exact, and a ridge term keeps it small.
//
// The rows of the default sets are more accurate: they are read from a file and were trained on
// simulated skies.
#include "atmosphere/colour/band_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
namespace {

// The sum deviates from 1 because the file has seven decimals.
void ScaleToOne(std::vector<double>& share) {
  double sum = 0.0;
  for (const double value : share) sum += value;
  for (double& value : share) value /= sum;
}

std::vector<TrainedBands> ReadSets() {
  const auto columns =
      atmosphere::ReadColumns("atmosphere/data/band_matrices.csv", {0, 1, 2, 3, 4});
  std::vector<TrainedBands> sets;
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    if (row == 0 || columns[0][row] != columns[0][row - 1]) sets.emplace_back();
    sets.back().wavelengths_nm.push_back(columns[1][row]);
    for (std::size_t c = 0; c < 3; ++c) sets.back().share[c].push_back(columns[2 + c][row]);
  }
  for (TrainedBands& set : sets) {
    for (std::vector<double>& share : set.share) ScaleToOne(share);
  }
  return sets;
}

using Triple = std::array<double, 3>;
using Seen = std::array<double, 4>;  // X, Y, Z of the cones; scotopic luminance of the rods

constexpr std::size_t kMostTrainedBands = 16;
constexpr double kFirst_nm = 360.0;  // range of the colour-matching functions
constexpr double kLast_nm = 830.0;

// Returns the hat function of band i at a wavelength: its weight in linear interpolation between
// the bands.
double Hat(std::span<const double> nodes, std::size_t i, double at) {
  if (at <= nodes[i]) {
    if (i == 0) return 1.0;
    return std::max(0.0, (at - nodes[i - 1]) / (nodes[i] - nodes[i - 1]));
  }
  if (i + 1 == nodes.size()) return 1.0;
  return std::max(0.0, (nodes[i + 1] - at) / (nodes[i + 1] - nodes[i]));
}

// The colour of sunlight in one narrow interval of wavelengths, and the middle of that interval.
struct Slice {
  double wavelength_nm;
  Seen seen;
};

// Returns colour-matching functions times the solar spectrum, integrated over steps of 5 nm by the
// midpoint rule in steps of 0.5 nm: daylight divided by sunlight is smooth over 5 nm.
const std::vector<Slice>& SunlightSlices() {
  static const std::vector<Slice> slices = [] {
    constexpr double kStep_nm = 5.0;
    constexpr double kFine_nm = 0.5;
    std::vector<Slice> made;
    for (double low = kFirst_nm; low < kLast_nm; low += kStep_nm) {
      Slice slice{low + 0.5 * kStep_nm, {}};
      for (double at = low + 0.5 * kFine_nm; at < low + kStep_nm; at += kFine_nm) {
        const Triple matching = ColourMatching(at);
        const double power = kLuminousEfficacy_lm_per_W * SolarTable()(at) * kFine_nm;
        for (std::size_t c = 0; c < 3; ++c) slice.seen[c] += matching[c] * power;
        slice.seen[3] += ScotopicEfficiency(at) * kScotopicEfficacy_lm_per_W /
                         kLuminousEfficacy_lm_per_W * power;
      }
      made.push_back(slice);
    }
    return made;
  }();
  return slices;
}

// Vertical optical depths at a wavelength: molecules, aerosol relative to 550 nm, 300 DU of ozone.
struct Air {
  double molecules, log_wavelength_ratio, ozone;
};

Air AirAt(double wavelength_nm) {
  constexpr double kOzoneColumn_per_m2 = 300.0 * 2.6867811e20;
  return {RayleighScatteringAtSeaLevel(std::clamp(wavelength_nm, 250.0, 4000.0)) * 8000.0,
          std::log(wavelength_nm / 550.0), OzoneCrossSection(wavelength_nm) * kOzoneColumn_per_m2};
}

// One spectrum of the family: sunlight attenuated by a number of vertical columns of molecules,
// haze (optical depth at 550 nm) and ozone. If `path` is not 0, the light is also scattered by
// molecules and haze along a path, which may be long enough to saturate, and again by molecules.
struct Daylight {
  double molecules, haze, exponent, ozone;
  double path, haze_source, again;
};

double RelativeToSun(const Daylight& light, const Air& air) {
  const double haze = std::exp(-light.exponent * air.log_wavelength_ratio);
  const double attenuation =
      std::exp(-(light.molecules * air.molecules + light.haze * haze + light.ozone * air.ozone));
  if (light.path == 0.0) return attenuation;
  const double source = air.molecules + light.haze_source * haze;
  return -std::expm1(-light.path * source) * (1.0 + light.again * air.molecules) * attenuation;
}

// The family contains sunlight from the zenith to the horizon, and skies from the zenith to the
// horizon, from noon to twilight whose light has crossed the ozone layer almost along the layer.
std::vector<Daylight> DaylightFamily() {
  std::vector<Daylight> family;
  for (const double exponent : {0.6, 1.4}) {
    for (const double molecules : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
      for (const double haze : {0.02, 0.1, 0.3}) {
        family.push_back({molecules, haze * molecules, exponent, molecules, 0.0, 0.0, 0.0});
      }
    }
    for (const double path : {0.01, 1.0, 8.0}) {
      for (const double haze_source : {0.05, 0.5}) {
        for (const double molecules : {0.2, 1.0, 3.0, 10.0}) {
          for (const double haze : {0.02, 0.2}) {
            for (const double ozone : {0.5, 2.0, 6.0, 15.0, 35.0}) {
              for (const double again : {0.0, 3.0}) {
                family.push_back(
                    {molecules, haze * molecules, exponent, ozone, path, haze_source, again});
              }
            }
          }
        }
      }
    }
  }
  return family;
}

// The least-squares system of one row of the matrix.
class NormalEquations {
 public:
  explicit NormalEquations(std::size_t unknowns) : n_(unknowns), a_(n_ * n_), b_(n_) {}

  void Add(std::span<const double> row, double target, double weight) {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) a_[i * n_ + j] += weight * row[i] * row[j];
      b_[i] += weight * row[i] * target;
    }
  }
  // Adds a ridge term, which keeps the system positive definite.
  void AddRidge(double ridge) {
    for (std::size_t i = 0; i < n_; ++i) a_[i * n_ + i] += ridge;
  }

  [[nodiscard]] std::vector<double> Solve() const { return SolvePositiveDefinite(a_, b_); }

 private:
  std::size_t n_;
  std::vector<double> a_, b_;
};

// One spectrum of the family: its true colour, and its values in the bands.
struct Example {
  Seen seen;
  std::vector<double> bands;
};

std::vector<Example> Examples(std::span<const double> wavelengths_nm) {
  std::vector<std::pair<Air, Seen>> slices;
  for (const Slice& slice : SunlightSlices()) {
    slices.emplace_back(AirAt(slice.wavelength_nm), slice.seen);
  }
  std::vector<Air> bands;
  for (const double wavelength_nm : wavelengths_nm) bands.push_back(AirAt(wavelength_nm));
  std::vector<Example> examples;
  for (const Daylight& light : DaylightFamily()) {
    Example example{};
    for (const auto& [air, seen] : slices) {
      const double f = RelativeToSun(light, air);
      for (std::size_t c = 0; c < 4; ++c) example.seen[c] += f * seen[c];
    }
    for (const Air& air : bands) example.bands.push_back(RelativeToSun(light, air));
    examples.push_back(std::move(example));
  }
  return examples;
}

using BandRow = std::vector<double>;

BandRow Starting(std::span<const double> wavelengths_nm, std::size_t component) {
  BandRow row(wavelengths_nm.size(), 0.0);
  for (const Slice& slice : SunlightSlices()) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] += Hat(wavelengths_nm, i, slice.wavelength_nm) * slice.seen[component];
    }
  }
  return row;
}

double Sum(const BandRow& row) {
  double sum = 0.0;
  for (const double value : row) sum += value;
  return sum;
}

double Dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Returns a row plus the correction that fits it to the examples. Errors are relative to the
// component, but at least to a fiftieth of the luminance: the blue component of a deep red sun is
// not visible.
BandRow Corrected(BandRow row, const std::vector<Example>& examples, std::size_t component) {
  constexpr double kWeightOfSun = 1e5;
  constexpr double kRidge = 1e-5;
  const double whole = Sum(row);
  NormalEquations equations(row.size());
  for (const Example& example : examples) {
    const double scale = example.seen[component] + 0.02 * example.seen[1];
    const double residual = example.seen[component] - Dot(row, example.bands);
    equations.Add(example.bands, residual / whole,
                  whole * whole / (scale * scale) / static_cast<double>(examples.size()));
  }
  equations.Add(std::vector<double>(row.size(), 1.0), 0.0, kWeightOfSun);
  equations.AddRidge(kRidge);
  const BandRow correction = equations.Solve();
  for (std::size_t i = 0; i < row.size(); ++i) row[i] += whole * correction[i];
  return row;
}

void RequireAscending(const std::vector<double>& wavelengths_nm) {
  ALPENGLOW_ENSURE(wavelengths_nm.size(), >, std::size_t{0});
  for (std::size_t i = 1; i < wavelengths_nm.size(); ++i) {
    ALPENGLOW_ENSURE(wavelengths_nm[i - 1], <, wavelengths_nm[i]);
  }
}

// Returns the rows that compute X, Y, Z and scotopic luminance from radiance relative to the sun.
std::array<BandRow, 4> BandRowsOf(std::span<const double> wavelengths_nm) {
  std::array<BandRow, 4> rows;
  for (std::size_t c = 0; c < 4; ++c) rows[c] = Starting(wavelengths_nm, c);
  if (wavelengths_nm.size() <= kMostTrainedBands) {
    const std::vector<Example> examples = Examples(wavelengths_nm);
    for (std::size_t c = 0; c < 4; ++c) rows[c] = Corrected(std::move(rows[c]), examples, c);
  }
  if (const TrainedBands* trained = FindTrainedBands(wavelengths_nm)) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double sun = Sum(Starting(wavelengths_nm, c));
      rows[c] = trained->share[c];
      for (double& value : rows[c]) value *= sun;
    }
  }
  return rows;
}

Triple Product(std::span<const double> matrix, std::span<const double> bands) {
  const std::size_t n = bands.size();
  return {Dot(matrix.subspan(0, n), bands), Dot(matrix.subspan(n, n), bands),
          Dot(matrix.subspan(2 * n, n), bands)};
}

SpectrumOf<double> InDouble(const Spectrum& light) {
  SpectrumOf<double> values(light.size());
  std::copy_n(light.values().begin(), light.size(), values.values().begin());
  return values;
}

}  // namespace

const std::vector<TrainedBands>& TrainedBandSets() {
  static const std::vector<TrainedBands> sets = ReadSets();
  return sets;
}

const TrainedBands* FindTrainedBands(std::span<const double> wavelengths_nm) {
  for (const TrainedBands& set : TrainedBandSets()) {
    if (std::equal(set.wavelengths_nm.begin(), set.wavelengths_nm.end(), wavelengths_nm.begin(),
                   wavelengths_nm.end())) {
      return &set;
    }
  }
  return nullptr;
}

std::optional<std::string> FaultOfColours(std::span<const double> wavelengths_nm) {
  constexpr double kBlue_nm = 480.0, kRed_nm = 600.0, kWidestGap_nm = 300.0;
  std::string fault;
  if (wavelengths_nm.front() > kBlue_nm || wavelengths_nm.back() < kRed_nm)
    fault = fmt::format("reaches from {} to {}", wavelengths_nm.front(), wavelengths_nm.back());
  for (std::size_t i = 1; i < wavelengths_nm.size() && fault.empty(); ++i) {
    const double low = wavelengths_nm[i - 1], high = wavelengths_nm[i];
    if (high - low > kWidestGap_nm && low < kRed_nm && high > kBlue_nm)
      fault = fmt::format("has nothing between {} and {}", low, high);
  }
  if (fault.empty()) return std::nullopt;
  return fmt::format(
      "spectrum.wavelengths_nm {}; for colours it must reach from at most {} to at "
      "least {} with gaps of at most {}",
      fault, kBlue_nm, kRed_nm, kWidestGap_nm);
}

BandColour::BandColour(std::vector<double> wavelengths_nm)
    : wavelengths_nm_(std::move(wavelengths_nm)) {
  RequireAscending(wavelengths_nm_);
  const std::size_t n = wavelengths_nm_.size();
  const std::array<BandRow, 4> rows = BandRowsOf(wavelengths_nm_);
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      (c < 3 ? xyz_ : scotopic_).push_back(rows[c][i] / SolarIrradiance(wavelengths_nm_[i]));
    }
  }
  for (const auto& srgb_row : LinearSrgbFromXyz()) {
    for (std::size_t i = 0; i < n; ++i) {
      srgb_.push_back(srgb_row[0] * xyz_[i] + srgb_row[1] * xyz_[n + i] +
                      srgb_row[2] * xyz_[2 * n + i]);
    }
  }
}

std::array<double, 3> BandColour::Xyz(std::span<const double> radiance) const {
  ALPENGLOW_ENSURE(radiance.size(), ==, wavelengths_nm_.size());
  return Product(xyz_, radiance);
}

std::array<double, 3> BandColour::LinearSrgb(std::span<const double> radiance) const {
  ALPENGLOW_ENSURE(radiance.size(), ==, wavelengths_nm_.size());
  return Product(srgb_, radiance);
}

double BandColour::ScotopicLuminance(std::span<const double> radiance) const {
  ALPENGLOW_ENSURE(radiance.size(), ==, wavelengths_nm_.size());
  return Dot(scotopic_, radiance);
}

std::array<double, 3> BandColour::Xyz(const Spectrum& radiance) const {
  return Xyz(InDouble(radiance).values());
}

std::array<double, 3> BandColour::LinearSrgb(const Spectrum& radiance) const {
  return LinearSrgb(InDouble(radiance).values());
}

double BandColour::ScotopicLuminance(const Spectrum& radiance) const {
  return ScotopicLuminance(InDouble(radiance).values());
}

}  // namespace alpenglow::atmosphere
