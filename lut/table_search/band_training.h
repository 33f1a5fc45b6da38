// SPDX-License-Identifier: MIT
// This header provides the training of the conversion from a few bands to colour.
//
// With f the light relative to the sun above the air, the tristimulus values relative to the sun's
// are, exactly and from bands,
//
//   X_c = sum_j A_cj f(lambda_j)  over FineWavelengths(),     X'_c = sum_i M_ci f(band i),
//
// both with rows that sum to 1: the sun itself has one colour on every set. For small errors
// CIEDE2000 squared is a quadratic form in X' - X, with a metric G for each colour. Summed over the
// spectra it is a quadratic form in (A - M S), where S selects the bands; its matrix of 3 n x 3 n
// is computed once. The best M for a set of bands then follows from a small linear system, and many
// sets can be tried.
//
// The metric of CIEDE2000 as a quadratic form: Pant and Farup (2012), Color Res. Appl. 37, 396-406;
// here by finite differences.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lut/table_search/sky_spectra.h"

namespace alpenglow::lut {

/// Conversion from light relative to the sun to colour relative to the sun's. Rows sum to 1.
struct BandShares {
  std::vector<double> wavelengths_nm;  // from FineWavelengths(), ascending
  std::array<std::vector<double>, 3> share;

  bool operator==(const BandShares&) const = default;
};

/// CIEDE2000 at an exposure that gives each colour two fifths of the luminance of white. White has
/// the chromaticity of the sun above the air.
struct ColourErrors {
  std::size_t count = 0;
  double mean = 0.0, percentile95 = 0.0, greatest = 0.0;
};

/// Return the relative colour of a spectrum at FineWavelengths(), by the shares and exactly.
[[nodiscard]] std::array<double, 3> RelativeXyz(const BandShares& shares,
                                                std::span<const double> relative_to_sun);
[[nodiscard]] std::array<double, 3> RelativeXyz(std::span<const double> relative_to_sun);

/// Return the errors of colours against the exact ones of their spectra. @param spectra not empty.
[[nodiscard]] ColourErrors ErrorsOf(std::span<const std::array<double, 3>> relative_xyz,
                                    std::span<const SkySpectrum> spectra);
[[nodiscard]] ColourErrors ErrorsOf(const BandShares& shares, std::span<const SkySpectrum> spectra);
[[nodiscard]] std::vector<SkySpectrum> OfRegime(SkyRegime regime,
                                                std::span<const SkySpectrum> spectra);

/// Sums over spectra, from which the best matrix for any set of bands follows. Day, sunset and
/// twilight have equal weight, the direct sun has half of it.
class BandTrainer {
 public:
  /// @param spectra some of every regime.
  explicit BandTrainer(std::span<const SkySpectrum> spectra);

  /// Returns the best shares of bands at these wavelengths, which must be in FineWavelengths().
  [[nodiscard]] BandShares Fit(std::span<const double> wavelengths_nm) const;

  /// Returns the best set of `bands` bands, multiples of `step_nm`: coordinate search from several
  /// starts.
  [[nodiscard]] std::vector<double> Search(int bands, int step_nm) const;

 private:
  using Set = std::vector<std::size_t>;  // indices of FineWavelengths()

  struct Fitted {
    std::array<std::vector<double>, 3> share;
    double cost;
  };
  [[nodiscard]] Fitted FitSet(const Set& set) const;
  [[nodiscard]] static std::vector<double> Change(std::span<const double> products,
                                                  std::span<const double> gradient);
  [[nodiscard]] Set Descend(Set set, std::size_t step) const;
  void Accumulate(const SkySpectrum& spectrum, double weight);

  std::size_t n_;                   // number of wavelengths
  std::vector<double> products_;    // 3 n x 3 n
  std::vector<double> with_exact_;  // products_ times the exact rows
  double exact_ = 0.0;              // the exact rows times with_exact_
};

}  // namespace alpenglow::lut
