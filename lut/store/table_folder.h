// SPDX-License-Identifier: MIT
// A folder of the tables of one atmosphere: made, read, described.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lut/program/progress.h"
#include "lut/store/table_file.h"

namespace alpenglow::lut {

/// How fine the tables are. Sizes and build times: skylut build --help.
struct TableQuality {
  TransmittanceTableSize transmittance;
  ScatteringTableSize single_scattering;
  DiffuseLightOptions multiple_scattering;
  int ray_nodes = 12;
};

/// Which orders of scattering the tables of a folder hold.
enum class TableOrders { kAll, kSingleOnly };

/// "preview", "standard" or "fine"; throws InputError for another name.
[[nodiscard]] TableQuality TableQualityFromName(std::string_view name);

/// Makes the folder when there is none. Throws OutputError naming it.
void MakeFolder(const std::filesystem::path& folder);

/// Builds and writes every table, each file whole or not at all; makes the folder when there is
/// none. Throws OutputError naming what could not be written.
void BuildTableFolder(const Medium& medium, const TableQuality& quality, TableOrders orders,
                      const std::filesystem::path& folder, ProgressStyle style);

/// Tables of one medium. What is absent is integrated where it is needed (see FolderUse).
struct TableFolder {
  Medium medium;
  std::optional<TransmittanceTable> transmittance;
  std::optional<ScatteringTable> single_scattering;
  std::optional<DiffuseLight> multiple_scattering;
  int ray_nodes = 12;
};

/// Reads the tables that the file of multiple scattering tells of; the other two where it is
/// missing. Throws InputError when one is missing or bad, or when they are not of this medium, or
/// of the same one.
[[nodiscard]] TableFolder ReadTableFolder(const std::filesystem::path& folder,
                                          const std::optional<std::uint64_t>& medium_hash = {});

/// DescriptionText of a table, or of every table in a folder. Throws InputError when there is none.
[[nodiscard]] std::string DescribeTables(const std::filesystem::path& file_or_folder);

}  // namespace alpenglow::lut
