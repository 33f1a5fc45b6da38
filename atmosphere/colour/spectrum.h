// SPDX-License-Identifier: MIT
// Spectra on a wavelength set, published tables of spectra (sun, air, water, ice, black body), and
// the conversion from bands to colour.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <alpenglow/spectrum.h>

namespace alpenglow::atmosphere {

/// A published table of y over x, interpolated linearly between its points.
class SampledFunction {
 public:
  /// @param x strictly ascending, with the length of y, at least one point.
  SampledFunction(std::vector<double> x, std::vector<double> y);

  /// Interpolates linearly between the points; returns the end values beyond them.
  [[nodiscard]] double operator()(double x) const;
  /// Returns the exact mean of the piecewise linear function over [low, high], low < high.
  [[nodiscard]] double Mean(double low, double high) const;

  [[nodiscard]] std::span<const double> x() const { return x_; }
  [[nodiscard]] std::span<const double> y() const { return y_; }

 private:
  std::vector<double> x_, y_;
};

/// Numbers of bands that WavelengthSet accepts.
inline constexpr std::array<int, 7> kWavelengthSetSizes{3, 4, 5, 6, 8, 16, 40};

/// Returns the wavelengths [nm] of a set with this number of bands; throws InputError for a number
/// that is not in kWavelengthSetSizes. Sets of 3 to 6 bands are optimised for colour
/// (data/band_matrices.csv); sets of 8, 16 and 40 are uniform.
[[nodiscard]] std::vector<double> WavelengthSet(int bands);

/// Returns the solar spectral irradiance at 1 au [W m^-2 nm^-1], mean over 10 nm around the
/// wavelength. ASTM G173-03 (Gueymard).
/// @param wavelength_nm in [300, 900], clamped to the ends of the table beyond.
[[nodiscard]] double SolarIrradiance(double wavelength_nm);

/// Returns the Rayleigh scattering coefficient of dry air at sea level, 288.15 K, 1013.25 hPa
/// [1/m]. Bodhaine et al. (1999), J. Atmos. Ocean. Tech. 16, 1854, equation 29; 360 ppm CO2.
/// @param wavelength_nm in [250, 4000].
[[nodiscard]] double RayleighScatteringAtSeaLevel(double wavelength_nm);

/// Returns the ozone absorption cross section at 233 K [m^2 per molecule], linear in a 10 nm table,
/// 0 outside it.
[[nodiscard]] double OzoneCrossSection(double wavelength_nm);

/// Returns the CIE 1931 2-degree colour-matching functions at a wavelength, linear in the 5 nm
/// table, 0 outside it.
[[nodiscard]] std::array<double, 3> ColourMatching(double wavelength_nm);

/// Returns the CIE 1951 scotopic luminous efficiency (of the rods), linear in the 10 nm table, 0
/// outside it.
[[nodiscard]] double ScotopicEfficiency(double wavelength_nm);

using Matrix3 = std::array<std::array<double, 3>, 3>;
/// Matrices from CIE XYZ to linear sRGB (Rec. 709 primaries, D65), and back. IEC 61966-2-1.
[[nodiscard]] const Matrix3& LinearSrgbFromXyz();
[[nodiscard]] const Matrix3& XyzFromLinearSrgb();
[[nodiscard]] std::array<double, 3> operator*(const Matrix3& matrix,
                                              const std::array<double, 3>& vector);

/// Returns what is wrong with wavelengths whose light shall become colours, or std::nullopt.
/// Wavelengths must reach from at most 480 nm to at least 600 nm, and neighbours in between must
/// not be more than 300 nm apart. Light at other wavelengths says too little about the light that
/// the eye sees: from 200 and 210 nm, a sky would have a luminance below zero.
[[nodiscard]] std::optional<std::string> FaultOfColours(std::span<const double> wavelengths_nm);

/// Converts spectral radiance in bands to colour. The wavelengths should have no FaultOfColours.
///
/// XYZ [cd m^-2 when radiance is W m^-2 sr^-1 nm^-1; Y is luminance] is a 3 x N matrix times the
/// bands. For the sets of WavelengthSet the matrix is trained on simulated skies
/// (data/band_matrices.csv, made by tests/bench/train_bands.cpp). For other sets it is the integral
/// of the colour-matching functions over radiance, where radiance is the solar spectrum times a
/// function that is linear between the bands. With at most 16 bands this matrix is corrected to the
/// least-squares fit, in relative XYZ, to a family of daylight spectra (sun through air, haze and
/// ozone, and light scattered by them). The sun above the air has the same XYZ on every wavelength
/// set, to 1e-4 (if the bands of the solar spectrum are those of SolarIrradiance).
///
/// Error of the sets of WavelengthSet, CIEDE2000 at equal exposure, bounds of the mean and of the
/// 95th percentile: 3 bands 0.9 and 2.5, 4 bands 0.2 and 0.6, 5 bands 0.08 and 0.2, 6 bands 0.03
/// and 0.08, 8 bands 0.03 and 0.1, 16 and 40 bands 0.02 and 0.05; for {450, 500, 590, 650}, which
/// is not trained, 0.7 and 1.6. The references are integration in 0.5 nm steps over 513 skies and
/// suns of three atmospheres by single scattering (tests/atmosphere/colour/spectrum_test.cpp), and
/// 5 nm steps over skies of all orders, land, sun and ground from 60 degrees down to -10
/// (tests/lut/table_search/band_training_test.cpp).
class BandColour {
 public:
  explicit BandColour(std::vector<double> wavelengths_nm);

  /// @param radiance one value per band.
  [[nodiscard]] std::array<double, 3> Xyz(std::span<const double> radiance) const;
  [[nodiscard]] std::array<double, 3> Xyz(const Spectrum& radiance) const;
  [[nodiscard]] std::array<double, 3> LinearSrgb(std::span<const double> radiance) const;
  [[nodiscard]] std::array<double, 3> LinearSrgb(const Spectrum& radiance) const;

  /// Returns the scotopic luminance [scotopic cd/m^2], the luminance for the rods, by a row fitted
  /// to the family of daylight spectra. Error over the skies and suns of the tests above, mean and
  /// 95th percentile: 3 bands 4 % and 8 %, 4 bands 1 % and 3.1 %, more bands 0.2 % and 0.3 %.
  [[nodiscard]] double ScotopicLuminance(std::span<const double> radiance) const;
  [[nodiscard]] double ScotopicLuminance(const Spectrum& radiance) const;

  /// Returns the row-major 3 x N matrix from bands to linear sRGB [cd/m^2 per W m^-2 sr^-1 nm^-1].
  [[nodiscard]] std::span<const double> linear_srgb_from_bands() const { return srgb_; }
  [[nodiscard]] const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }

 private:
  std::vector<double> wavelengths_nm_;
  std::vector<double> xyz_, srgb_, scotopic_;
};

/// Returns a spectral albedo in [0, 1] on the wavelengths whose colour under equal-energy light,
/// with white scaled to (1, 1, 1), is the given linear sRGB. The albedo is a mixture of a red, a
/// green and a blue surface with smooth edges that add up to 1 (see spectrum.cpp). Greys have a
/// flat albedo. A colour more saturated than these surfaces is moved to the nearest mixture by
/// clamping the weights to [0, 1].
///
/// On a set of WavelengthSet the three surfaces are changed as little as possible so that, through
/// BandColour and under the sun above the air, they have the colours of their full spectra. In
/// daylight (sun at 30 degrees) surfaces then keep their colour on four bands within a CIEDE2000 of
/// 0.3 in the mean and 0.6 at most, over 27 colours with channels 0.1 to 0.6
/// (tests/lut/table_search/band_training_test.cpp); at sunset 0.8, in twilight 2 in the mean.
[[nodiscard]] std::vector<double> AlbedoFromLinearSrgb(const std::array<double, 3>& rgb,
                                                       std::span<const double> wavelengths_nm);

/// Returns the extraterrestrial solar spectrum of ASTM G173-03 [W m^-2 nm^-1], 300 to 900 nm in
/// steps of 0.5 and 1 nm, for integrals that must resolve its lines.
[[nodiscard]] const SampledFunction& SolarTable();

/// Returns Planck's spectral radiance [W m^-2 sr^-1 nm^-1]. The constants of CODATA 2018 are exact.
[[nodiscard]] double BlackBodyRadiance(double wavelength_nm, double temperature_k);

/// Returns the absorption coefficient of pure water [1/m]: Pope, Fry (1997), Appl. Opt. 36, 8710,
/// and from 730 nm Smith, Baker (1981), Appl. Opt. 20, 177; linear in a 10 nm table from 380 to
/// 750 nm, the end values beyond.
[[nodiscard]] double WaterAbsorption(double wavelength_nm);

/// Returns the scattering coefficient of pure sea water [1/m], half of it backwards: 0.00288
/// (lambda / 500 nm)^-4.32, Morel (1974), Optical Properties of Pure Water and Pure Sea Water.
[[nodiscard]] double SeaWaterScattering(double wavelength_nm);

/// Returns the absorption coefficient of pure ice [1/m], 4 pi k / lambda: Warren, Brandt (2008), J.
/// Geophys. Res. 113, D14220; k linear in a 10 nm table from 380 to 750 nm, the end values beyond.
[[nodiscard]] double IceAbsorption(double wavelength_nm);

}  // namespace alpenglow::atmosphere
