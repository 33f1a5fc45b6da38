// SPDX-License-Identifier: MIT
/// @file
/// Spectra and colours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// Throws the InputError of a number of bands that a spectrum cannot have.
[[noreturn]] void RefuseBands(std::size_t bands);
/// Throws the InputError of a band that a spectrum does not have.
[[noreturn]] void RefuseBand(std::size_t band, std::size_t bands);
/// Throws the InputError of an operation on two spectra with different numbers of bands.
[[noreturn]] void RefuseOperands(std::size_t bands, std::size_t others);

/// One value for each wavelength of an atmosphere. It is a plain value without memory on the heap, and
/// the type of the library's own light, transmittances and reflectances.
template <typename Real>
class SpectrumOf {
 public:
  /// Largest number of bands.
  static constexpr std::size_t kMostBands = 40;

  SpectrumOf() = default;
  /// Makes a spectrum of equal values. Throws InputError unless `bands` lies in [0, kMostBands].
  explicit SpectrumOf(std::size_t bands, Real value = Real(0)) : size_(bands) {
    if (bands > kMostBands) RefuseBands(bands);
    std::fill_n(values_.begin(), bands, value);
  }

  /// Returns the number of bands.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns the value of a band. Throws InputError unless `band` is below size().
  [[nodiscard]] Real& operator[](std::size_t band) {
    if (band >= size_) RefuseBand(band, size_);
    return values_[band];
  }
  /// Returns the value of a band. Throws InputError unless `band` is below size().
  [[nodiscard]] const Real& operator[](std::size_t band) const {
    if (band >= size_) RefuseBand(band, size_);
    return values_[band];
  }
  /// Returns all values.
  [[nodiscard]] std::span<const Real> values() const { return {values_.data(), size_}; }
  /// Returns all values.
  [[nodiscard]] std::span<Real> values() { return {values_.data(), size_}; }

  /// Returns whether two spectra have the same number of bands and the same values.
  friend bool operator==(const SpectrumOf& a, const SpectrumOf& b) {
    return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end());
  }
  /// Returns the sums, band by band. Throws InputError for different numbers of bands.
  friend SpectrumOf operator+(SpectrumOf a, const SpectrumOf& b) {
    if (a.size_ != b.size_) RefuseOperands(a.size_, b.size_);
    for (std::size_t band = 0; band < a.size_; ++band) a.values_[band] += b.values_[band];
    return a;
  }
  /// Returns the products, band by band. Throws InputError for different numbers of bands.
  friend SpectrumOf operator*(SpectrumOf a, const SpectrumOf& b) {
    if (a.size_ != b.size_) RefuseOperands(a.size_, b.size_);
    for (std::size_t band = 0; band < a.size_; ++band) a.values_[band] *= b.values_[band];
    return a;
  }
  /// Returns a spectrum times a number.
  friend SpectrumOf operator*(Real factor, SpectrumOf a) {
    for (std::size_t band = 0; band < a.size_; ++band) a.values_[band] *= factor;
    return a;
  }

 private:
  std::array<Real, kMostBands> values_;  // the first size_ values; the others are never read
  std::size_t size_ = 0;
};

/// Light, transmittance or reflectance of each band.
using Spectrum = SpectrumOf<float>;

/// A colour in linear sRGB (Rec. 709 primaries, D65). A channel of a colour outside the gamut is
/// negative.
struct LinearRgb {
  double red = 0.0;    ///< [cd/m^2] of radiances
  double green = 0.0;  ///< [cd/m^2] of radiances
  double blue = 0.0;   ///< [cd/m^2] of radiances
};

/// Returns the luminance of a colour, in its unit (CIE 1931 Y; IEC 61966-2-1). Throws InputError
/// for a channel that is not finite.
[[nodiscard]] double Luminance(const LinearRgb& colour);

}  // namespace alpenglow
