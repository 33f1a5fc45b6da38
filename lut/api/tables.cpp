// SPDX-License-Identifier: MIT
#include <alpenglow/tables.h>

#include <alpenglow/errors.h>

#include <utility>

#include "lut/api/conversions.h"
#include "lut/cli/output_file.h"
#include "lut/table_io/exchange_tables.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow {
namespace {

const char* NameOf(BakeQuality quality) {
  switch (quality) {
    case BakeQuality::kPreview:
      return "preview";
    case BakeQuality::kStandard:
      return "standard";
    case BakeQuality::kFine:
      return "fine";
  }
  throw InputError("quality is no BakeQuality");
}

lut::ExchangeLayout LayoutOf(TableUser user) {
  switch (user) {
    case TableUser::kBrunetonDemo:
      return lut::ExchangeLayout::kBruneton;
    case TableUser::kThreeAtmosphere:
      return lut::ExchangeLayout::kTakram;
  }
  throw InputError("user is no TableUser");
}

}  // namespace

void BakeTables(const Atmosphere& atmosphere, const std::filesystem::path& folder,
                BakeQuality quality) {
  lut::BuildTableFolder(atmosphere.medium(), lut::TableQualityFromName(NameOf(quality)),
                        lut::TableOrders::kAll, folder, lut::ProgressStyle::kQuiet);
}

Sky ReadTables(const std::filesystem::path& folder) {
  lut::TableFolder tables = lut::ReadTableFolder(folder);
  if (!tables.multiple_scattering) {
    throw InputError(folder.string() + ": " + lut::kMultipleScatteringFileName + " is missing");
  }
  const Atmosphere atmosphere(tables.medium);
  return Sky(std::make_shared<const Sky::State>(
      Sky::State{atmosphere, lut::TableLookup(std::move(tables))}));
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
                  TableUser user) {
  lut::ExchangeOptions options;
  options.layout = LayoutOf(user);
  lut::RequireThreeBands(atmosphere.medium());
  lut::MakeFolder(folder);  // before the tables are computed
  lut::WriteExchangeTables(
      lut::MakeExchangeTextures(atmosphere.medium(), options, lut::ProgressStyle::kQuiet),
      atmosphere.medium(), options, folder);
}

}  // namespace alpenglow
