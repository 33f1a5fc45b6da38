// SPDX-License-Identifier: MIT
// Tables in OpenEXR files, one a table, each of which knows the medium it was made for.
//
//   transmittance       T.0450nm ...                            columns mu, rows r
//   single scattering   rayleigh.0450nm ..., mie.0450nm ...     columns nu * n(mu_s) + mu_s,
//                                                               rows r * n(mu) + mu
//
// 32-bit floats, ZIP, first row = ground. Text attributes alpenglow.*: kind, quantity, units, axes,
// axisSizes, layout, mapVersion, mediumHash, mediumName, medium (a whole atmosphere.toml),
// producer, and lowestMuS of single scattering. Fractional wavelengths have a comma, as in
// rayleigh.0450,500nm: a dot separates layers.
//
// Every reader throws InputError naming the file for what is damaged, cut short or foreign, for
// texels that are not in [0, 1], another version of the map, and another medium than asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lut/scattering_table.h"
#include "lut/transmittance_table.h"

namespace alpenglow {

/// Versions of the maps of transmittance_map.glsl and scattering_map.glsl: a table of another is
/// refused.
inline constexpr int kTransmittanceMapVersion = 1;
inline constexpr int kScatteringMapVersion = 1;

/// Names in a folder of tables.
inline constexpr const char* kTransmittanceFileName = "transmittance.exr";
inline constexpr const char* kSingleScatteringFileName = "single_scattering.exr";

/// Writes whole or not at all. Throws OutputError naming the file.
void WriteTable(const std::filesystem::path& file, const TransmittanceTable& table);
void WriteTable(const std::filesystem::path& file, const ScatteringTable& table);

/// @param medium_hash  of the medium the table must be made for; any, when absent.
[[nodiscard]] TransmittanceTable ReadTransmittanceTable(
    const std::filesystem::path& file, const std::optional<std::uint64_t>& medium_hash = {});
[[nodiscard]] ScatteringTable ReadScatteringTable(
    const std::filesystem::path& file, const std::optional<std::uint64_t>& medium_hash = {});

/// The medium a table was made for, checked against its hash; reads no texels.
[[nodiscard]] Medium ReadMediumOfTable(const std::filesystem::path& file);

/// What a file says about itself, after every texel was checked.
struct TableDescription {
  struct ChannelRange {
    std::string name;
    double lowest, highest, mean;
  };
  std::string kind, quantity, units, axes, axis_sizes, layout, map_version, producer;
  Medium medium;
  std::uint64_t bytes = 0;  // of texels
  std::vector<ChannelRange> channels;
};
[[nodiscard]] TableDescription DescribeTable(const std::filesystem::path& file);

/// The same for people: a line a fact.
[[nodiscard]] std::string DescriptionText(const std::filesystem::path& file,
                                          const TableDescription& description);

}  // namespace alpenglow
