// SPDX-License-Identifier: MIT
/// @file
/// Tables of an atmosphere in files: transmittance, single scattering and multiple scattering.
#pragma once

#include <filesystem>
#include <string>

#include <alpenglow/atmosphere.h>
#include <alpenglow/export.h>
#include <alpenglow/sky.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// Resolution of tables. For the four bands of "earth", a folder holds about 2.5, 26 and 96 MB of
/// values.
enum class BakeQuality { kPreview, kStandard, kFine };

/// Computes all tables of an atmosphere, on all processors, and writes them into a folder, which is
/// created if it is missing: transmittance.exr, single_scattering.exr and multiple_scattering.exr.
/// Each file is replaced atomically and contains the atmosphere. Throws OutputError naming a file
/// that cannot be written.
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

/// Writes the textures that another program loads, texel for texel, and atmosphere.toml into a
/// folder, which is created if it is missing. Throws InputError unless the atmosphere has three
/// wavelengths, as "bruneton2017" does, and OutputError naming a file that cannot be written.
void ExportTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                  TableUser user);

}  // namespace alpenglow
