// SPDX-License-Identifier: MIT
// The medium of the atmosphere: three species over a spherical planet, on a wavelength set, with
// the allowed ranges of its parameters and its text form.
//
//   molecules   sigma(h) = rayleigh_scattering [(1 + d) exp(-h / H_R) - d exp(-h / H_D)]
//                                                                           scattering only
//   aerosol     sigma(h) = mie_scattering      exp(-h / H_M)                scattering, absorption
//   ozone       sigma(h) = ozone_absorption    layer(h)                     absorption only
//
// Above the top there is no medium. SI units except wavelengths [nm].
//
// The ranges are defined once, for the check of a medium and for the reader of its file. A medium
// can be written as the text of an atmosphere.toml: tables store this text so that their medium can
// be rebuilt.
#pragma once

#include <alpenglow/spectrum.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere::ranges {

struct Range {
  double low, high;
};

inline constexpr Range kWavelength_nm{200.0, 4000.0};
inline constexpr Range kSolarIrradiance{0.0, 1e6};
inline constexpr Range kAlbedo{0.0, 1.0};
/// Coefficients up to an optical depth of 1e5 in a layer of 1 m.
inline constexpr Range kCoefficient_per_m{0.0, 1e5};
/// For radii beyond 1e8 m (40 % more than Jupiter) light along grazing rays is wrong by 0.1 % in
/// double and 1 % in float. The lower limit depends on the air (kLeastRadiusInScaleHeights and
/// below).
inline constexpr Range kPlanetRadius_m{1e3, 1e8};
inline constexpr Range kAtmosphereTop_m{1.0, 1e7};
/// In a layer of 100 m, sixteen nodes along a ray have an error of 0.2 % (rms) to 1 % of the single
/// scattering, and more in thinner layers. Renderers treat such layers as separate media.
inline constexpr Range kScaleHeight_m{100.0, 2e5};
inline constexpr Range kDeficit{0.0, 1.0};
inline constexpr Range kDepolarisation{0.0, kLargestDepolarisation};
inline constexpr Range kOzoneAltitude_m{0.0, 1e7};

/// Radius over scale height. Columns are computed with two terms of a series in the inverse of this
/// ratio (optical_depth.glsl), with an error of 0.19 of its square: 3e-4 of an optical depth here,
/// at most 1e-3 of single scattering.
inline constexpr double kLeastRadiusInScaleHeights = 25.0;
/// The least distance from the peak of ozone to either end of its layer: single precision can
/// resolve it, and the density in between has a finite slope.
inline constexpr double kLeastOzoneSide_m = 1.0;
/// Radius over the top of a smooth layer of ozone. The quadrature of this layer has an error of
/// 5e-4 of the column at this ratio, 1e-2 at half of it and an unbounded error below that.
inline constexpr double kLeastRadiusInSmoothOzone = 3.0;

/// Top over the molecules' scale height. Nodes of multiple scattering are uniform in the root of
/// the altitude: beyond this ratio they do not resolve the lowest layer of air (2 % error at 300,
/// 10 % at 1200).
inline constexpr double kHighestTopInScaleHeights = 300.0;
/// The top of the atmosphere must be at least this fraction of the top of a smooth layer of ozone
/// (cutting off 5e-7 of its column).
inline constexpr double kEndOfSmoothOzone = 0.9;
/// Number of scale heights of the deficit of molecules after which the deficit is negligible
/// (3e-4).
inline constexpr double kEndOfDeficit = 8.0;

/// Maximum number of bands of a medium: one per nanometre from 360 to 830 nm, and some more.
inline constexpr std::size_t kMostWavelengths = 512;

}  // namespace alpenglow::atmosphere::ranges

namespace alpenglow::atmosphere {

/// The excess of a single exponential near the ground, relative to the density there: air that
/// cools upwards, as below 11 km on Earth, thins out more slowly than the air above it.
struct MoleculeDeficit {
  double share = 0.0;  // d, in [0, 1]
  double scale_height_m = 4000.0;

  bool operator==(const MoleculeDeficit&) const = default;
};

/// Selects the height profile of the refractivity: the density of the molecules, or the standard
/// air of almanacs (kAlmanacLayers of atmosphere/refraction/refraction.h), whose gradient near the
/// ground determines the refraction of a low sun.
enum class RefractionBy { kMolecules, kAlmanacs };

/// kTent: linear from 0 at the bottom to 1 at the peak to 0 at the top (Bruneton 2017). kSmooth:
/// (27/4 y (1 - y)^2)^4 with y = h / top and the peak at top / 3. The kinks of a tent make kinks in
/// the light of twilight, which no quadrature with few nodes can resolve; the smooth layer has
/// none.
enum class OzoneShape { kTent, kSmooth };

/// Density profile of ozone over altitude, relative to its peak.
struct OzoneLayer {
  double bottom_m = 10000.0;
  double peak_m = 25000.0;
  double top_m = 40000.0;
  OzoneShape shape = OzoneShape::kTent;

  bool operator==(const OzoneLayer&) const = default;
};

/// Returns a smooth layer with its peak at `peak_m`. The default is the layer of the earth presets:
/// peak at 22 km, mean at 23.6 km, standard deviation 8.2 km.
[[nodiscard]] OzoneLayer SmoothOzone(double peak_m = 22000.0);

/// Returns the height [m] of a layer of uniform density 1 with the same column.
[[nodiscard]] double EquivalentDepth_m(const OzoneLayer& layer);

/// Lists hold one value per wavelength.
struct Medium {
  std::string name = "earth";
  /// True if the ground is the WGS84 ellipsoid: a renderer then replaces planet_radius_m by the
  /// radius of the sphere that osculates it at the viewer. False if the planet is a sphere of
  /// exactly planet_radius_m.
  bool follows_wgs84 = true;
  double planet_radius_m = 6371008.7714;
  double atmosphere_height_m = 120000.0;  // top above the ground

  std::vector<double> wavelengths_nm;    // ascending, in [200, 4000]
  std::vector<double> solar_irradiance;  // W m^-2 nm^-1 above the air; at 1 au ("mars": 1.524 au)
  std::vector<double> ground_albedo;     // [0, 1], Lambertian

  std::vector<double> rayleigh_scattering_per_m;  // at altitude 0
  double rayleigh_scale_height_m = 8000.0;
  MoleculeDeficit rayleigh_deficit = {};
  /// Depolarisation of the molecules: for light scattered by 90 degrees, the ratio of the component
  /// polarised in the scattering plane to the component perpendicular to it; one for all
  /// wavelengths, or one per wavelength, in [0, 1/2]. It shapes the phase function; the scattering
  /// coefficient is used as given.
  std::vector<double> rayleigh_depolarisation{0.0};
  /// Refraction bends lines of sight and does not change the light.
  RefractionBy refraction = RefractionBy::kMolecules;

  std::vector<double> mie_scattering_per_m;  // at altitude 0
  std::vector<double> mie_extinction_per_m;  // at altitude 0, >= scattering
  double mie_scale_height_m = 1200.0;
  /// Phase functions of the aerosol: one for all wavelengths, or one per wavelength, all of one
  /// kind.
  std::vector<PhaseFunction> mie_phase{PhaseFunction{}};

  std::vector<double> ozone_absorption_per_m;  // at the peak of the layer
  OzoneLayer ozone;

  /// True if multiple scattering is computed with polarisation (molecules polarise, aerosol and
  /// ground depolarise), which is physically correct; false if light is treated as unpolarised
  /// after each scattering, which is common in renderers. True of every preset but "bruneton2017".
  bool polarised = false;

  bool operator==(const Medium&) const = default;
};

/// Returns the density of the molecules relative to altitude 0.
[[nodiscard]] double MoleculeDensity(const Medium& medium, double altitude_m);
/// Returns the column of the molecules above an altitude, divided by their density at altitude 0
/// [m].
[[nodiscard]] double MoleculeColumn_m(const Medium& medium, double altitude_m = 0.0);

/// Returns the depolarisation of the molecules at the wavelength of this index.
[[nodiscard]] inline double Depolarisation(const Medium& medium, std::size_t band) {
  const std::vector<double>& values = medium.rayleigh_depolarisation;
  return values.size() == 1 ? values.front() : values[band];
}

/// Returns the phase function of the molecules [1/sr], one value per wavelength.
/// @param cos_scattering  as for Phase().
[[nodiscard]] std::vector<double> RayleighPhaseValues(const Medium& medium, double cos_scattering);

/// Returns the aerosol's phase function at the wavelength of this index.
[[nodiscard]] inline const PhaseFunction& MiePhase(const Medium& medium, std::size_t band) {
  return medium.mie_phase.size() == 1 ? medium.mie_phase.front() : medium.mie_phase[band];
}

/// Returns the aerosol's phase function [1/sr], one value per wavelength; evaluated once if all
/// wavelengths share it.
/// @param cos_scattering  as for Phase().
[[nodiscard]] std::vector<double> MiePhaseValues(const Medium& medium, double cos_scattering);

/// A parameter out of range: its key in atmosphere.toml, and one line of text with key, value and
/// range.
struct MediumFault {
  std::string key;
  std::string text;
  std::vector<std::string> causes{};  // other keys on which the allowed range of `key` depends

  bool operator==(const MediumFault&) const = default;
};

/// The use of the light of a medium, which limits its wavelengths.
struct MediumUse {
  std::size_t most_wavelengths = ranges::kMostWavelengths;
  bool shows_colours = false;     // the wavelengths have no FaultOfColours (colour/spectrum.h)
  std::string_view purpose = "";  // in messages, such as "pictures"
};

/// Largest number of bands of light (alpenglow/spectrum.h).
inline constexpr std::size_t kMaxBands = Spectrum::kMostBands;
inline constexpr MediumUse kForLight{.most_wavelengths = kMaxBands,
                                     .purpose = "integrals and tables"};
inline constexpr MediumUse kForPictures{
    .most_wavelengths = kMaxBands, .shows_colours = true, .purpose = "pictures"};

/// Returns what is wrong with the wavelengths of a medium, if anything is.
[[nodiscard]] std::optional<MediumFault> FaultOfWavelengths(
    const std::vector<double>& wavelengths_nm, const MediumUse& use);

/// Returns the first parameter out of range, if there is one.
[[nodiscard]] std::optional<MediumFault> FindFault(const Medium& medium, const MediumUse& use = {});

/// Throws InputError naming the key, the value and the range of the first parameter out of range.
void Validate(const Medium& medium, const MediumUse& use = {});

/// Returns a 64-bit hash (FNV-1a over the bit patterns, -0 read as 0) of everything that a table
/// depends on: all parameters except the name and the refraction. It is stable over programs,
/// machines and versions.
[[nodiscard]] std::uint64_t MediumHash(const Medium& medium);

/// Returns the radius [m] of the sphere that osculates the ellipsoid at a latitude if follows_wgs84
/// is set, and the planet's radius if the planet is a sphere.
[[nodiscard]] double OsculatingRadius(const Medium& medium, double latitude_rad);

/// Returns the medium over the sphere with this radius.
[[nodiscard]] Medium OnOsculatingSphere(Medium medium, double latitude_rad);

/// Returns one of "earth", "bruneton2017", "clear-mountain", "hazy", "mars". Without wavelengths,
/// "bruneton2017" has 680, 550, 440 nm of the publication, given ascending, and the others the four
/// optimised bands. All but "bruneton2017" accept other wavelengths, ascending in [360, 830], the
/// range of the underlying tables. Throws InputError for an unknown name or a wavelength out of
/// range. The source of every number is in medium_presets.cpp.
[[nodiscard]] Medium MediumPreset(std::string_view name);
[[nodiscard]] Medium MediumPreset(std::string_view name, const std::vector<double>& wavelengths_nm);
[[nodiscard]] std::vector<std::string> MediumPresetNames();
/// Returns the depolarisation of a preset's gas at these wavelengths in [200, 4000]: dry air
/// (AirDepolarisation), or carbon dioxide for "mars".
[[nodiscard]] std::vector<double> GasDepolarisation(std::string_view preset,
                                                    const std::vector<double>& wavelengths_nm);
/// Returns the phase functions of a preset's aerosol: one per wavelength, or one for all for
/// "bruneton2017".
/// @param wavelengths_nm  ascending; beyond the tables the values at the ends of the tables are
/// used.
[[nodiscard]] std::vector<PhaseFunction> AerosolPhase(std::string_view preset,
                                                      const std::vector<double>& wavelengths_nm);
/// Returns the medium with polarised multiple scattering and the depolarisation of the preset's
/// gas.
[[nodiscard]] Medium InPolarisedLight(Medium medium, std::string_view preset);
/// Returns the medium with scalar multiple scattering and molecules without depolarisation, as in
/// other renderers.
[[nodiscard]] Medium InScalarLight(Medium medium);

/// Range of wavelengths [nm] in which every preset but "bruneton2017" has data.
inline constexpr double kFirstPresetWavelength_nm = 360.0;
inline constexpr double kLastPresetWavelength_nm = 830.0;

}  // namespace alpenglow::atmosphere
