// SPDX-License-Identifier: MIT
// This header provides tables that other programs load: the files of Bruneton's demo (2017) and of
// three-atmosphere (takram), texel for texel.
//
// Red, green and blue of the textures are the three wavelengths of the medium, longest first. The
// mapping is that of table_maps.glsl, with the sun down to mu_s_min, which is a constant of the
// loading program: cos 120 degrees in three-atmosphere. In Bruneton's demo it is cos 102 degrees
// when compiled for half precision, which is the default, whatever the precision of the files, and
// cos 120 degrees when compiled for single precision. The textures hold:
//
//   transmittance           256 x 64        mu, r               to the top of the air; A = 1
//   irradiance              64 x 16         mu_s, r (linear)    of the sky on a horizontal plane,
//                                                               without the sun's; A = 1
//   scattering              256 x 128 x 32  (nu, mu_s), mu, r   light scattered by molecules once
//                           + orders 2 to 4, both divided by the phase function at nu by which
//                           loaders multiply, that of molecules that do not depolarise; A = light
//                           scattered once by aerosol at the longest wavelength, without phase
//                           function
//   higher_order_scattering 256 x 128 x 32  orders 2 to 4 only; A = 0            (takram only)
//   single_mie_scattering   256 x 128 x 32  scattered once by aerosol; A = 1     (takram only)
//
// Radiances are in [W m^-2 nm^-1], times sr^-1 after multiplication by the phase function,
// irradiances in [W m^-2 nm^-1]. Irradiance counts light scattered up to three times, as in those
// programs, because it is the source of their fourth order.
//
// Bruneton (2017), "Precomputed atmospheric scattering: a new implementation". The values are
// integrals of this project: closed forms, 16 Gauss nodes, moments of successive orders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/table_io/table_image.h"
#include "lut/tables/scattering_table.h"

namespace alpenglow::lut {

/// Name of the file beside the tables that holds their medium.
inline constexpr const char* kMediumFileName = "atmosphere.toml";

/// Parse "bruneton" or "takram", "float" or "half", and "exr", "bin" or "dat". Throw InputError for
/// other names.
[[nodiscard]] TableUser TableUserFromName(std::string_view name);
[[nodiscard]] TexelType TexelTypeFromName(std::string_view name);
[[nodiscard]] std::vector<std::string> TexelTypeNames();
[[nodiscard]] TexelFormat TexelFormatFromName(std::string_view name);
[[nodiscard]] std::vector<std::string> TexelFormatNames();

/// Returns the phase function of molecules of a medium over that by which loaders multiply.
/// @param nu  cosine of the scattering angle.
[[nodiscard]] double PhaseOverThatOfLoaders(const Medium& medium, std::size_t band, double nu);

/// Values of ExportOptions::lowest_sun_deg.
inline constexpr double kDemoLowestSun_deg = 102.0;
inline constexpr double kLowestSun_deg = 120.0;

/// Returns the reason why no program loads such files: takram has no .dat, its .bin is half, its
/// lowest sun 120 degrees; bruneton has no .bin, its .dat is float; other values of `user` are no
/// programs. Returns nullopt if a program loads them.
[[nodiscard]] std::optional<std::string> FaultOf(const ExportOptions& options);

/// Return the zenith angle of the lowest sun of these options, and its cosine.
[[nodiscard]] double LowestSunAngle_deg(const ExportOptions& options);
[[nodiscard]] double LowestSunOf(const ExportOptions& options);

/// Throws InputError unless the medium has red, green and blue.
void RequireThreeBands(const Medium& medium);

/// Returns whether the medium is the preset bruneton2017, which programs with fixed constants
/// assume.
[[nodiscard]] bool IsTheMediumThatLoadersAssume(const Medium& medium);

/// Name and size of a texture: constants of the programs that load it.
struct TextureShape {
  const char* name;
  std::size_t width, height, depth;
};
inline constexpr TextureShape kTransmittanceShape{"transmittance", 256, 64, 1};
inline constexpr TextureShape kIrradianceShape{"irradiance", 64, 16, 1};
inline constexpr ScatteringTableSize kExchangeScatteringSize{
    .nu = 8, .mu_s = 32, .mu = 128, .altitudes = 32};

/// Returns the textures of a program, in the order of MakeExchangeTextures.
[[nodiscard]] std::vector<TextureShape> ShapesOf(TableUser user);

/// Returns ".exr", ".bin" or ".dat".
[[nodiscard]] std::string SuffixOf(TexelFormat format);

/// Return the light scattered two to four times [1/sr], for unit solar irradiance. These are the
/// orders that the tables contain.
[[nodiscard]] MultipleScattering FourOrdersOf(const Medium& medium);
[[nodiscard]] Spectrum HigherOrdersAlong(const SingleScattering<float>& air,
                                         const MultipleScattering& light, const ViewRay& ray);

/// One texture in the layout of those programs: texel (x, y, z) is rgba[4 * ((z * height + y) *
/// width + x)], with 3-D textures stacked along the rows.
struct ExchangeTexture {
  std::string name;
  std::size_t width, height, depth;
  std::vector<float> rgba;
};

/// Number of calls of `row_done` by MakeExchangeTextures.
inline constexpr std::size_t kExchangeRows = 2 * ScatteringTable::Rows(kExchangeScatteringSize);

/// Returns all textures of a program. The result does not depend on the number of threads. Throws
/// InputError unless the medium has three wavelengths.
/// @param row_done  is called after each row, from any thread; an exception ends the work.
[[nodiscard]] std::vector<ExchangeTexture> MakeExchangeTextures(
    const Medium& medium, const ExportOptions& options,
    const std::function<void()>& row_done = [] {});

/// Writes the textures into a folder, which is created if it is missing: one file NAME.exr or .bin
/// or .dat each, and atmosphere.toml, the medium that they were made for. EXR files have channels R
/// G B A, ZIP, layers of 3-D textures below each other. Those of takram have their rows reversed
/// (last row of the last layer on top), as its loader requires. Throws InputError (see FaultOf) and
/// OutputError.
void WriteExchangeTables(const std::vector<ExchangeTexture>& textures, const Medium& medium,
                         const ExportOptions& options, const std::filesystem::path& folder);

}  // namespace alpenglow::lut
