// SPDX-License-Identifier: MIT
// Tables that other programs load: the files of Bruneton's demo (2017) and of three-atmosphere
// (takram), texel for texel.
//
// The textures and what they hold, for red, green and blue = the three wavelengths of the
// medium, longest first; the mapping is that of transmittance_map.glsl and
// scattering_map.glsl, the sun down to mu_s_min, which the loading program has as a constant:
// cos 120 degrees in three-atmosphere; in Bruneton's demo cos 102 degrees when compiled for
// half precision, as it stands, whatever the files' own precision, and cos 120 degrees when
// compiled for single precision:
//
//   transmittance           256 x 64        mu, r               to the top of the air; A = 1
//   irradiance              64 x 16         mu_s, r (linear)    of the sky on a horizontal plane,
//                                                               without the sun's; A = 1
//   scattering              256 x 128 x 32  (nu, mu_s), mu, r   scattered once by molecules,
//   without
//                           phase function, + orders 2 to 4 over the molecules' phase function at
//                           nu; A = scattered once by aerosol at the longest wavelength, likewise
//   higher_order_scattering the same        orders 2 to 4 alone; A = 0           (takram only)
//   single_mie_scattering   the same        scattered once by aerosol; A = 1     (takram only)
//
// Radiances [W m^-2 nm^-1] times sr^-1 after the phase function, irradiances [W m^-2 nm^-1].
// Irradiance counts light scattered up to three times, as those programs do: what their fourth
// order is made of.
//
// Bruneton (2017), "Precomputed atmospheric scattering: a new implementation"; the values are
// integrals of this project: closed forms, 16 Gauss nodes, moments of successive orders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/air/medium.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/program/messages.h"
#include "lut/store/table_image.h"
#include "lut/table/scattering_table.h"

namespace alpenglow::lut {

/// Beside the tables: the medium that they were made for.
inline constexpr const char* kMediumFileName = "atmosphere.toml";

enum class ExchangeLayout { kBruneton, kTakram };
/// kDat and kBin: texels and nothing else, little-endian, RGBA interleaved, x fastest, first row of
/// the first layer first.
enum class TexelFormat { kExr, kBin, kDat };

/// "float" or "half"; "exr", "bin" or "dat". Throw InputError for other names.
[[nodiscard]] TexelType TexelTypeFromName(std::string_view name);
[[nodiscard]] TexelFormat TexelFormatFromName(std::string_view name);

struct ExchangeOptions {
  ExchangeLayout layout = ExchangeLayout::kTakram;
  /// Without a value: takram half .exr, bruneton float .dat.
  std::optional<TexelType> type = {};
  std::optional<TexelFormat> format = {};
  /// Zenith angle, kDemoLowestSun_deg or kLowestSun_deg;
  /// without a value what the program as it stands assumes.
  std::optional<double> lowest_sun_deg = {};
};
inline constexpr double kDemoLowestSun_deg = 102.0;
inline constexpr double kLowestSun_deg = 120.0;

/// Why no program loads such files: takram has no .dat, its .bin is half, its lowest sun 120
/// degrees; bruneton has no .bin, its .dat is float. Nothing when one does.
[[nodiscard]] std::optional<std::string> FaultOf(const ExchangeOptions& options);

/// Zenith angle of the lowest sun of these options, and its cosine.
[[nodiscard]] double LowestSunAngle_deg(const ExchangeOptions& options);
[[nodiscard]] double LowestSunOf(const ExchangeOptions& options);

/// Throws InputError unless the medium has red, green and blue.
void RequireThreeBands(const Medium& medium);

/// The medium that programs with fixed constants assume: the preset bruneton2017.
[[nodiscard]] bool IsTheMediumThatLoadersAssume(const Medium& medium);

/// What a texture is called and how large it is: constants of the programs that load it.
struct TextureShape {
  const char* name;
  std::size_t width, height, depth;
};
inline constexpr TextureShape kTransmittanceShape{"transmittance", 256, 64, 1};
inline constexpr TextureShape kIrradianceShape{"irradiance", 64, 16, 1};
inline constexpr ScatteringTableSize kExchangeScatteringSize{
    .nu = 8, .mu_s = 32, .mu = 128, .altitudes = 32};

/// The textures of a layout, in the order of MakeExchangeTextures.
[[nodiscard]] std::vector<TextureShape> ShapesOf(ExchangeLayout layout);

/// ".exr", ".bin" or ".dat".
[[nodiscard]] const char* SuffixOf(TexelFormat format);

/// Light scattered two to four times [1/sr], for unit solar irradiance, which these tables count.
[[nodiscard]] DiffuseLight FourOrdersOf(const Medium& medium);
[[nodiscard]] Bands<float> HigherOrdersAlong(const AirIntegrator<float>& air,
                                             const DiffuseLight& light, const ViewRay& ray);

/// One texture as those programs hold it: texel (x, y, z) is
/// rgba[4 * ((z * height + y) * width + x)], 3-D textures stacked
/// along the rows.
struct ExchangeTexture {
  std::string name;
  std::size_t width, height, depth;
  std::vector<float> rgba;
};

/// All textures of a layout. The same for any number of threads. Throws InputError unless the
/// medium has three wavelengths.
[[nodiscard]] std::vector<ExchangeTexture> MakeExchangeTextures(const Medium& medium,
                                                                const ExchangeOptions& options,
                                                                ProgressStyle style);

/// Writes them into a folder, made when missing: NAME.exr or .bin or .dat each, and
/// atmosphere.toml, the medium that they were made for. EXR files have channels R G B A, ZIP,
/// layers of 3-D textures below each other; those of takram have their rows reversed (last row of
/// the last layer on top), as its loader wants. Throws InputError (see FaultOf) and OutputError.
void WriteExchangeTables(const std::vector<ExchangeTexture>& textures, const Medium& medium,
                         const ExchangeOptions& options, const std::filesystem::path& folder);

}  // namespace alpenglow::lut
