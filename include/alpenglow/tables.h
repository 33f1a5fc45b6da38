// SPDX-License-Identifier: MIT
/// @file
/// Tables of an atmosphere in files: transmittance, single scattering and multiple scattering.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <alpenglow/atmosphere.h>
#include <alpenglow/export.h>
#include <alpenglow/progress.h>
#include <alpenglow/sky.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// Resolution of tables. For the four bands of "earth", a folder holds about 2.5, 26 and 96 MB of
/// values.
enum class BakeQuality { kPreview, kStandard, kFine };

/// Resolution and content of the tables of an atmosphere.
struct BakeOptions {
  BakeQuality quality = BakeQuality::kStandard;  ///< see there
  /// Leaves multiple_scattering.exr out. ReadTables() refuses such a folder; "skylut eval" reads it.
  bool single_scattering_only = false;
};

/// Computes all tables of an atmosphere, on all processors, and writes them into a folder, which is
/// created if it is missing: transmittance.exr, single_scattering.exr and multiple_scattering.exr.
/// Each file is replaced atomically and contains the atmosphere. Throws OutputError naming a file
/// that cannot be written, InputError for an unknown quality, and Cancelled if `progress` ends the
/// work.
/// @param atmosphere  air of the tables.
/// @param folder      for the files.
/// @param options     see there.
/// @param progress    receives the fraction of the rows of single scattering, the largest table,
///   that are done; may be empty.
void BakeTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                const BakeOptions& options, const ProgressFunction& progress = {});

/// Computes and writes all tables of a quality as the function above does.
void BakeTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                BakeQuality quality = BakeQuality::kStandard);

/// Reads a folder of BakeTables() or "skylut build". Rays to space or to the ground are looked up
/// in the tables; aerial perspective between two points is integrated with their multiple
/// scattering. A table returns exactly the values that were written. Throws InputError naming the
/// file if a table is missing, damaged or made for another atmosphere than the others.
///
/// Error of the luminance of Radiance() against that of a Sky of the same atmosphere, from the
/// ground to 3 km, relative to it or to a thousandth of the mean of the sky: below 8 % (rms) for
/// every preset and every mixture of aerosols with tables of the quality kPreview, and below 2 % in
/// the dust of "mars" with kStandard (asserted by same_light_test).
[[nodiscard]] Sky ReadTables(const std::filesystem::path& folder);

/// Reads a folder like ReadTables(folder) and throws InputError unless it was made for this
/// atmosphere.
[[nodiscard]] Sky ReadTables(const std::filesystem::path& folder, const Atmosphere& expected);

/// Returns a description of a table, or of all tables of a folder, for people: sizes, units, ranges
/// and origin. Every value is checked. Throws InputError for files that are no valid tables.
[[nodiscard]] std::string DescribeTables(const std::filesystem::path& file_or_folder);

/// Programs whose table files can be written: the demo of Bruneton (2017) and three-atmosphere
/// (takram).
enum class TableUser { kBrunetonDemo, kThreeAtmosphere };

/// Type of the texels of a file.
enum class TexelType { kFloat, kHalf };

/// Format of a file. kDat and kBin hold only texels: little-endian, RGBA interleaved, x fastest, the
/// first row of the first layer first.
enum class TexelFormat { kExr, kBin, kDat };

/// Files that another program loads.
struct ExportOptions {
  TableUser user = TableUser::kThreeAtmosphere;  ///< the program
  /// By default kHalf for three-atmosphere and kFloat for the demo of Bruneton, whose kDat is float.
  /// The kBin of three-atmosphere is half.
  std::optional<TexelType> type = {};
  /// By default kExr for three-atmosphere, which also loads kBin, and kDat for the demo of Bruneton,
  /// which also loads kExr.
  std::optional<TexelFormat> format = {};
  /// Zenith angle of the lowest sun in the tables [degrees], a constant of the program: 120 for
  /// three-atmosphere and for the demo of Bruneton in single precision, 102 for that demo in half
  /// precision, which is its default.
  std::optional<double> lowest_sun_deg = {};
};

/// Writes the textures that another program loads, texel for texel, and atmosphere.toml into a
/// folder, which is created if it is missing. Throws InputError unless the atmosphere has three
/// wavelengths, as "bruneton2017" does, and for options that the program does not load, OutputError
/// naming a file that cannot be written, and Cancelled if `progress` ends the work.
/// @param atmosphere  air of the tables.
/// @param folder      for the files.
/// @param options     see there.
/// @param progress    receives the fraction of the rows of scattering that are done; may be empty.
void ExportTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                  const ExportOptions& options, const ProgressFunction& progress = {});

/// Writes the files of a program in its default format as the function above does.
void ExportTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                  TableUser user);

}  // namespace alpenglow
