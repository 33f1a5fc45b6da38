// SPDX-License-Identifier: MIT
#include <alpenglow/tables.h>

#include <alpenglow/errors.h>

#include <cstddef>
#include <utility>

#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/cli/output_file.h"
#include "lut/table_io/exchange_tables.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow {

void BakeTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                const BakeOptions& options, const ProgressFunction& progress) {
  const std::size_t rows =
      lut::ScatteringTable::Rows(lut::SizesOf(options.quality).single_scattering);
  lut::BuildTableFolder(atmosphere.medium(), options, folder, PartDone(progress, rows));
}

void BakeTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                BakeQuality quality) {
  BakeTables(atmosphere, folder, BakeOptions{.quality = quality});
}

Sky ReadTables(const std::filesystem::path& folder) {
  lut::TableFolder tables = lut::ReadTableFolder(folder);
  if (!tables.multiple_scattering) {
    throw InputError(folder.string() + ": " + lut::kMultipleScatteringFileName + " is missing");
  }
  const Atmosphere atmosphere(tables.medium);
  return SkyParts::Made(atmosphere, std::move(tables));
}

Sky ReadTables(const std::filesystem::path& folder, const Atmosphere& expected) {
  Sky sky = ReadTables(folder);
  if (sky.atmosphere().hash() != expected.hash()) {
    throw InputError(folder.string() + ": the tables were made for another atmosphere than " +
                     expected.name());
  }
  return sky;
}

std::string DescribeTables(const std::filesystem::path& file_or_folder) {
  return lut::DescribeTables(file_or_folder);
}

void ExportTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                  const ExportOptions& options, const ProgressFunction& progress) {
  if (const auto fault = lut::FaultOf(options)) throw InputError(*fault);
  lut::RequireThreeBands(atmosphere.medium());
  lut::MakeFolder(folder);  // before the tables are computed
  lut::WriteExchangeTables(lut::MakeExchangeTextures(atmosphere.medium(), options,
                                                     PartDone(progress, lut::kExchangeRows)),
                           atmosphere.medium(), options, folder);
}

void ExportTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                  TableUser user) {
  ExportTables(atmosphere, folder, ExportOptions{.user = user});
}

}  // namespace alpenglow
