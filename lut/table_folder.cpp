// SPDX-License-Identifier: MIT
#include "lut/table_folder.h"

#include <system_error>

#include "atmosphere/error.h"

namespace alpenglow {

namespace fs = std::filesystem;

TableQuality TableQualityFromName(std::string_view name) {
  if (name == "preview") {
    return {{.mu = 128, .altitudes = 32}, {.nu = 8, .mu_s = 24, .mu = 64, .altitudes = 16}};
  }
  if (name == "standard") return {};
  if (name == "fine") {
    return {{.mu = 512, .altitudes = 128}, {.nu = 16, .mu_s = 48, .mu = 192, .altitudes = 48}};
  }
  throw InputError(fmt::format("quality is \"{}\"; it must be preview, standard or fine", name));
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    throw OutputError(fmt::format("{}: no such folder can be made: {}", folder.string(),
                                  error ? error.message() : "it is a file"));
  }
}

void BuildTableFolder(const Medium& medium, const TableQuality& quality, const fs::path& folder,
                      ProgressStyle style) {
  MakeFolder(folder);
  WriteTable(folder / kTransmittanceFileName, TransmittanceTable(medium, quality.transmittance));
  Progress progress("single scattering", ScatteringTable::Rows(quality.single_scattering), style);
  WriteTable(
      folder / kSingleScatteringFileName,
      ScatteringTable(medium, {.size = quality.single_scattering, .lowest_mu_s = {}}, &progress));
}

TableFolder ReadTableFolder(const fs::path& folder,
                            const std::optional<std::uint64_t>& medium_hash) {
  TransmittanceTable transmittance =
      ReadTransmittanceTable(folder / kTransmittanceFileName, medium_hash);
  ScatteringTable single_scattering =
      ReadScatteringTable(folder / kSingleScatteringFileName, MediumHash(transmittance.medium()));
  return {std::move(transmittance), std::move(single_scattering)};
}

std::string DescribeTables(const fs::path& file_or_folder) {
  std::error_code error;
  if (!fs::is_directory(file_or_folder, error)) {
    return DescriptionText(file_or_folder, DescribeTable(file_or_folder));
  }
  std::string text;
  for (const char* name : {kTransmittanceFileName, kSingleScatteringFileName}) {
    const fs::path file = file_or_folder / name;
    if (fs::exists(file, error)) text += DescriptionText(file, DescribeTable(file));
  }
  if (text.empty()) {
    throw InputError(fmt::format("{}: has neither {} nor {}", file_or_folder.string(),
                                 kTransmittanceFileName, kSingleScatteringFileName));
  }
  return text;
}

}  // namespace alpenglow
