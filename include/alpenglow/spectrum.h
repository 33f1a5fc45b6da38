// SPDX-License-Identifier: MIT
/// @file
/// Spectra and colours.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// One value for each wavelength of an atmosphere. It is a plain value without memory on the heap.
class Spectrum {
 public:
  /// Largest number of bands.
  static constexpr std::size_t kMostBands = 40;

  Spectrum() = default;
  /// Makes a spectrum of zeros. Throws InputError unless `bands` lies in [0, kMostBands].
  explicit Spectrum(std::size_t bands) : size_(bands) {
    if (bands > kMostBands) RefuseSize(bands);
  }

  /// Returns the number of bands.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns the value of a band. Throws InputError unless `band` is below size().
  [[nodiscard]] float& operator[](std::size_t band) {
    if (band >= size_) RefuseBand(band, size_);
    return values_[band];
  }
  /// Returns the value of a band. Throws InputError unless `band` is below size().
  [[nodiscard]] float operator[](std::size_t band) const {
    if (band >= size_) RefuseBand(band, size_);
    return values_[band];
  }
  /// Returns all values.
  [[nodiscard]] std::span<const float> values() const { return {values_.data(), size_}; }

 private:
  [[noreturn]] static void RefuseSize(std::size_t bands);
  [[noreturn]] static void RefuseBand(std::size_t band, std::size_t size);

  std::array<float, kMostBands> values_{};
  std::size_t size_ = 0;
};

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
