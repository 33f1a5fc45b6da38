// SPDX-License-Identifier: MIT
// What the numbers of a medium may be: one place for the check of a medium and of its file.
//
// What the air is made of: three species over a spherical planet, on a wavelength set.
//
//   molecules   sigma(h) = rayleigh_scattering [(1 + d) exp(-h / H_R) - d exp(-h / H_D)]
//                                                                           scattering only
//   aerosol     sigma(h) = mie_scattering      exp(-h / H_M)                scattering, absorption
//   ozone       sigma(h) = ozone_absorption    layer(h)                     absorption only
//
// and nothing above the top. SI units except wavelengths [nm].
//
// A medium as the text of an atmosphere.toml: what files carry so that their medium can be rebuilt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/air/phase.h"

namespace alpenglow::atmosphere::ranges {

struct Range {
  double low, high;
};

inline constexpr Range kWavelength_nm{200.0, 4000.0};
inline constexpr Range kSolarIrradiance{0.0, 1e6};
inline constexpr Range kAlbedo{0.0, 1.0};
/// Up to an optical depth of 1e5 in a layer of 1 m.
inline constexpr Range kCoefficient_per_m{0.0, 1e5};
/// Beyond 1e8 m (40 % more than Jupiter) light along grazing rays is wrong by 0.1 % in double and 1
/// % in float; below, what is allowed depends on the air (kLeastRadiusInScaleHeights and below).
inline constexpr Range kPlanetRadius_m{1e3, 1e8};
inline constexpr Range kAtmosphereTop_m{1.0, 1e7};
/// In a layer of 100 m sixteen nodes along a ray leave 0.2 % (rms) to 1 % of what is scattered
/// once, and more in thinner ones. Fog is a medium of its own in pictures.
inline constexpr Range kScaleHeight_m{100.0, 2e5};
inline constexpr Range kDeficit{0.0, 1.0};
inline constexpr Range kDepolarisation{0.0, kLargestDepolarisation};
inline constexpr Range kOzoneAltitude_m{0.0, 1e7};

/// Radius over scale height. Columns are two terms of a series in its
/// inverse (optical_depth.glsl) that leave 0.19 of its square: 3e-4
/// of an optical depth here, at most 1e-3 of light scattered once.
inline constexpr double kLeastRadiusInScaleHeights = 25.0;
/// The least distance from the peak of ozone to either end of its layer: single precision tells them
/// apart, and the density between them has a slope.
inline constexpr double kLeastOzoneSide_m = 1.0;
/// Radius over the top of a smooth layer of ozone, whose rule of nodes goes wrong by 5e-4 of its
/// column here, by 1e-2 at half of it and by any amount beyond.
inline constexpr double kLeastRadiusInSmoothOzone = 3.0;

/// Top over the molecules' scale height. Nodes of diffuse light stand at equal steps of the root of
/// the altitude: beyond this the lowest layer of air slips between them (2 % at 300, 10 % at 1200).
inline constexpr double kHighestTopInScaleHeights = 300.0;
/// The top may cut off this much of a smooth layer of ozone (5e-7 of its column).
inline constexpr double kEndOfSmoothOzone = 0.9;
/// Scale heights of the deficit of molecules after which nothing is left of it (3e-4).
inline constexpr double kEndOfDeficit = 8.0;

/// Most bands of a medium: one each nanometre from 360 to 830 nm, and some.
inline constexpr std::size_t kMostWavelengths = 512;

}  // namespace alpenglow::atmosphere::ranges

namespace alpenglow::atmosphere {

/// What a single exponential has too much of near the ground, relative to the density there: air
/// that cools upwards, as below 11 km on Earth, thins out more slowly than the air above it.
struct MoleculeDeficit {
  double share = 0.0;  // d, in [0, 1]
  double scale_height_m = 4000.0;

  bool operator==(const MoleculeDeficit&) const = default;
};

/// How the refractivity falls off with height: as the density of the molecules, or as in the air of
/// almanacs (kAlmanacLayers of atmosphere/sun/refraction.h), whose gradient near the ground is what
/// lifts a low sun.
enum class RefractionBy { kMolecules, kAlmanacs };

/// Tent: linear from 0 at the bottom to 1 at the peak to 0 at the top (Bruneton 2017).
/// Smooth: (27/4 y (1 - y)^2)^4 with y = h / top and the peak at top / 3. A tent bends the light of
/// twilight at its edges, which no quadrature with few nodes can follow; this does not.
enum class OzoneShape { kTent, kSmooth };

/// Ozone's density relative to its peak, over altitude.
struct OzoneLayer {
  double bottom_m = 10000.0;
  double peak_m = 25000.0;
  double top_m = 40000.0;
  OzoneShape shape = OzoneShape::kTent;

  bool operator==(const OzoneLayer&) const = default;
};

/// A smooth layer with its peak at `peak_m`. The default is that of the earth presets: peak at 22
/// km, mean at 23.6 km, standard deviation 8.2 km.
[[nodiscard]] OzoneLayer SmoothOzone(double peak_m = 22000.0);

/// Height [m] of a layer of density 1 throughout that holds as much.
[[nodiscard]] double EquivalentDepth_m(const OzoneLayer& layer);

/// Lists hold one value per wavelength.
struct Medium {
  std::string name = "earth";
  /// The ground is the WGS84 ellipsoid: a renderer replaces planet_radius_m by the radius of the
  /// sphere that osculates it at the viewer. False when the planet is a sphere of exactly
  /// planet_radius_m.
  bool follows_wgs84 = true;
  double planet_radius_m = 6371008.7714;
  double atmosphere_height_m = 120000.0;  // top above the ground

  std::vector<double> wavelengths_nm;    // ascending, in [200, 4000]
  std::vector<double> solar_irradiance;  // W m^-2 nm^-1 above the air; at 1 au ("mars": 1.524 au)
  std::vector<double> ground_albedo;     // [0, 1], Lambertian

  std::vector<double> rayleigh_scattering_per_m;  // at altitude 0
  double rayleigh_scale_height_m = 8000.0;
  MoleculeDeficit rayleigh_deficit = {};
  /// Of the molecules: of light scattered by 90 degrees, what vibrates in the plane of scattering
  /// over what vibrates across it; one for all wavelengths, or one per wavelength, in [0, 1/2]. It
  /// shapes their scattering; the coefficient is as given.
  std::vector<double> rayleigh_depolarisation{0.0};
  /// It bends lines of sight and changes no light.
  RefractionBy refraction = RefractionBy::kMolecules;

  std::vector<double> mie_scattering_per_m;  // at altitude 0
  std::vector<double> mie_extinction_per_m;  // at altitude 0, >= scattering
  double mie_scale_height_m = 1200.0;
  /// Of the aerosol: one for all wavelengths, or one per wavelength, all of one kind.
  std::vector<PhaseFunction> mie_phase{PhaseFunction{}};

  std::vector<double> ozone_absorption_per_m;  // at the peak of the layer
  OzoneLayer ozone;

  /// Whether light scattered more than once is followed with its polarisation (molecules polarise,
  /// aerosol and ground depolarise), as real light is, or as if each scattering left it
  /// unpolarised, as renderers do. True of every preset but "bruneton2017".
  bool polarised = false;

  bool operator==(const Medium&) const = default;
};

/// Density of the molecules relative to altitude 0.
[[nodiscard]] double MoleculeDensity(const Medium& medium, double altitude_m);
/// Column of the molecules over altitude 0 at their density there [m].
[[nodiscard]] double MoleculeColumn_m(const Medium& medium);

/// The molecules' at the wavelength of this index.
[[nodiscard]] inline double Depolarisation(const Medium& medium, std::size_t band) {
  const std::vector<double>& values = medium.rayleigh_depolarisation;
  return values.size() == 1 ? values.front() : values[band];
}

/// Values [1/sr] of the molecules' phase function, one per wavelength. @param cos_scattering  as
/// for Phase().
[[nodiscard]] std::vector<double> RayleighPhaseValues(const Medium& medium, double cos_scattering);

/// The aerosol's phase function at the wavelength of this index.
[[nodiscard]] inline const PhaseFunction& MiePhase(const Medium& medium, std::size_t band) {
  return medium.mie_phase.size() == 1 ? medium.mie_phase.front() : medium.mie_phase[band];
}

/// Values [1/sr] of the aerosol's phase function, one per wavelength; evaluated once when all share
/// it. @param cos_scattering  as for Phase().
[[nodiscard]] std::vector<double> MiePhaseValues(const Medium& medium, double cos_scattering);

/// A parameter out of range: its key in atmosphere.toml, and one line with key, value and range.
struct MediumFault {
  std::string key;
  std::string text;

  bool operator==(const MediumFault&) const = default;
};

/// The first parameter out of range, if there is one.
[[nodiscard]] std::optional<MediumFault> FindFault(const Medium& medium);

/// Throws InputError naming the key, the value and the range of the first parameter out of range.
void Validate(const Medium& medium);

/// A 64-bit hash (FNV-1a over the bit patterns, -0 read as 0) of everything that a table depends
/// on: all but the name and the refraction. Stable over programs, machines and versions.
[[nodiscard]] std::uint64_t MediumHash(const Medium& medium);

/// The medium over the sphere that osculates the ellipsoid at a latitude, where its ground is one;
/// unchanged where the planet is a sphere.
[[nodiscard]] Medium OnOsculatingSphere(Medium medium, double latitude_rad);

/// One of "earth", "bruneton2017", "clear-mountain", "hazy", "mars", on the preset's own
/// wavelengths
/// ("bruneton2017": 680, 550, 440 nm of the publication, given ascending; the others: the four
/// optimised bands) or, for all but "bruneton2017", on the ones given, ascending in [360, 830]
/// where the tables behind them reach. Throws InputError for another name or wavelength. Every
/// number's source is in medium_presets.cpp.
[[nodiscard]] Medium MediumPreset(std::string_view name);
[[nodiscard]] Medium MediumPreset(std::string_view name, const std::vector<double>& wavelengths_nm);
[[nodiscard]] std::vector<std::string> MediumPresetNames();
/// Depolarisation of a preset's gas at these wavelengths in [200, 4000]: of dry air
/// (AirDepolarisation), on "mars" of carbon dioxide.
[[nodiscard]] std::vector<double> GasDepolarisation(std::string_view preset,
                                                    const std::vector<double>& wavelengths_nm);
/// Phase functions of a preset's aerosol: one per wavelength, or, of "bruneton2017", one for all.
/// @param wavelengths_nm  ascending; beyond the tables they are as at the tables' ends.
[[nodiscard]] std::vector<PhaseFunction> AerosolPhase(std::string_view preset,
                                                      const std::vector<double>& wavelengths_nm);
/// The same medium in polarised light, scattered by the gas of the preset.
[[nodiscard]] Medium InPolarisedLight(Medium medium, std::string_view preset);
/// The same medium of round molecules in scalar light, as other renderers have it.
[[nodiscard]] Medium InScalarLight(Medium medium);

/// The wavelengths [nm] on which every preset but "bruneton2017" has data.
inline constexpr double kFirstPresetWavelength_nm = 360.0;
inline constexpr double kLastPresetWavelength_nm = 830.0;

/// Reads atmosphere.toml: a preset, changed by what the file gives (keys, units and meaning:
/// ATMOSPHERE_FILE.md). Wavelengths may ascend or descend; descending ones are stored reversed,
/// with every list of the file. Throws InputError "file:line: key ..." for unknown keys (with the
/// nearest known one), wrong types, NaN, infinities, lists of unequal length, values out of range,
/// keys that contradict each other or would have no effect, and malformed text. The name is the
/// preset's, or "custom (from PRESET)" when the file changes anything.
[[nodiscard]] Medium ReadMedium(const std::filesystem::path& file);

/// As ReadMedium, from text; `origin` stands in messages where the file's name would.
[[nodiscard]] Medium MediumFromToml(std::string_view text, const std::string& origin);

/// Every parameter, in the shortest digits that give the same double back:
/// MediumHash(MediumFromToml(TomlFromMedium(m), "")) == MediumHash(m). The name is not in it.
/// Throws InputError for a medium that no atmosphere.toml describes (a parameter set that its phase
/// function does not have).
[[nodiscard]] std::string TomlFromMedium(const Medium& medium);

}  // namespace alpenglow::atmosphere
