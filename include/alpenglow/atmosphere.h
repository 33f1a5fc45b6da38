// SPDX-License-Identifier: MIT
/// @file
/// Atmospheres: molecules, aerosol and ozone over a spherical planet, on a set of wavelengths.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <alpenglow/batch.h>
#include <alpenglow/export.h>
#include <alpenglow/geometry.h>
#include <alpenglow/spectrum.h>

namespace alpenglow::atmosphere {
struct Medium;
}

namespace ALPENGLOW_EXPORT alpenglow {

/// The parameters of an atmosphere. Immutable; copies share their memory.
class Atmosphere {
 public:
  /// Makes the preset "earth".
  Atmosphere();

  /// Returns a preset of PresetNames() on its default wavelengths: three for "bruneton2017", four
  /// optimised bands for the others. Throws InputError for another name.
  [[nodiscard]] static Atmosphere Preset(std::string_view name);

  /// Returns a preset on other wavelengths. Throws InputError for wavelengths that are out of range
  /// or more than Spectrum::kMostBands, and for "bruneton2017", which has only its own.
  /// @param name  of PresetNames().
  /// @param wavelengths_nm  ascending, in [360, 830].
  [[nodiscard]] static Atmosphere Preset(std::string_view name,
                                         const std::vector<double>& wavelengths_nm);

  /// Returns "earth", "bruneton2017", "clear-mountain", "hazy" and "mars".
  [[nodiscard]] static std::vector<std::string> PresetNames();

  /// Reads an atmosphere file; atmosphere/ATMOSPHERE_FILE.md describes its keys. Throws InputError
  /// "FILE:LINE: key ..." for a file that is missing or malformed, for an unknown key and for a
  /// value out of range.
  [[nodiscard]] static Atmosphere Read(const std::filesystem::path& file);

  /// Reads the text of an atmosphere file. Throws InputError like Read().
  [[nodiscard]] static Atmosphere FromToml(std::string_view text);

  /// Returns the text of an atmosphere file that gives the same parameters back, bit for bit.
  [[nodiscard]] std::string ToToml() const;

  /// Returns this atmosphere over the sphere that osculates the WGS84 ellipsoid at a latitude. A
  /// planet that is a sphere by itself ("mars") is unchanged. Throws InputError for a latitude out
  /// of range.
  /// @param latitude_deg  in [-90, 90].
  [[nodiscard]] Atmosphere AtLatitude(double latitude_deg) const;

  /// Returns the name: that of the preset, or "custom (from PRESET)".
  [[nodiscard]] const std::string& name() const;
  /// Returns the wavelengths [nm], ascending.
  [[nodiscard]] std::span<const double> wavelengths_nm() const;
  /// Returns the irradiance of the sun above the air, at its mean distance [W m^-2 nm^-1].
  [[nodiscard]] std::span<const double> solar_irradiance_w_per_m2_nm() const;
  /// Returns the radius of the sphere of altitude 0 [m].
  [[nodiscard]] double planet_radius_m() const;
  /// Returns the altitude above which there is no air [m].
  [[nodiscard]] double top_m() const;
  /// Returns a hash of all parameters that affect light. Table files store it. It is the same on
  /// all machines and in all versions.
  [[nodiscard]] std::uint64_t hash() const;

  /// Returns the colour of light under this sun: [cd/m^2] for radiance, [lx] for irradiance.
  ///
  /// The error of the default bands is a CIEDE2000 of 0.2 in the mean and 0.6 at the 95th
  /// percentile, over skies from noon to deep twilight (asserted by spectrum_test and
  /// band_training_test). Throws InputError for a spectrum of another number of bands or with
  /// values that are not finite, and if the wavelengths do not show colours: they must reach from
  /// at most 480 nm to at least 600 nm, with gaps of at most 300 nm in between.
  /// @param light  per unit of solar irradiance, as returned by Sky.
  [[nodiscard]] LinearRgb ColourOf(const Spectrum& light) const;

  /// Returns the transmittance [1] from a point along a straight ray to space, which is 0 if the
  /// ground is in the way, or over a distance, as Sky::Between(). Error: 6e-6 of the optical depth,
  /// or 1e-7 (asserted by transmittance_api_test). Throws InputError for a direction of length 0, a
  /// distance below 0, and points as Sky does.
  /// @param eye         the point.
  /// @param direction   of the ray.
  /// @param distance_m  of the end; infinite for space.
  [[nodiscard]] Spectrum Transmittance(
      const LocalPoint& eye, const Direction& direction,
      double distance_m = std::numeric_limits<double>::infinity()) const;

  /// Computes Transmittance() of many rays, see batch.h. Throws InputError for a number of values that
  /// is neither 1 nor that of the rays.
  void Transmittance(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& directions,
                     const OneOrMany<double>& distances_m, std::span<float> result) const;

  /// Makes an atmosphere from the parameters in the form of the sources of the library, which alone
  /// know it. Throws InputError for a parameter out of range.
  explicit Atmosphere(const atmosphere::Medium& medium);
  /// Returns the parameters in the form of the sources of the library.
  [[nodiscard]] const atmosphere::Medium& medium() const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace alpenglow
