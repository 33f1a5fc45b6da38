// SPDX-License-Identifier: MIT
// This header provides tables in OpenEXR files, one per table, each of which stores the medium it
// was made for.
//
//   transmittance       T.0450nm ...                            columns mu, rows r
//   single scattering   rayleigh.0450nm ..., mie.0450nm ...     columns nu * n(mu_s) + mu_s,
//                                                               rows r * n(mu) + mu
//                                                               or mu_s nu as mu_s azimuth: see
//                                                               ScatteringAxes
//   multiple scattering L00.0450nm, L10 ..., E.0450nm ...       columns mu_s, rows h
//                       of polarised light T20, T21, T22 too (polarised_scattering.h)
//
// The files hold 32-bit floats, ZIP, first row = ground. Text attributes alpenglow.*: kind,
// quantity, units, axes, axisSizes, layout, mapVersion, mediumHash, mediumName, medium (a whole
// atmosphere.toml), producer; lowestMuS of single scattering; and of multiple scattering degree (of
// the moments L_lm), orders, converged, sunCosines (of the columns; row j is altitude top (j / (n -
// 1))^2), rayNodes and tables (see FolderUse). Fractional wavelengths have a comma, as in
// rayleigh.0450,500nm, because a dot separates layers.
//
// Every reader throws InputError naming the file if it is damaged, truncated or of another format,
// if texels are out of range ([0, 1]; moments [-100, 100]), and if the version of the map or the
// medium differs from the requested one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/tables/scattering_table.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {

/// Versions of the maps of table_maps.glsl, and of the nodes of MultipleScattering. Readers refuse
/// tables of other versions.
inline constexpr int kTransmittanceMapVersion = 1;
inline constexpr int kScatteringMapVersion = 1;
inline constexpr int kMultipleScatteringMapVersion = 2;  // 1 had another share of forward peaks

/// Names in a folder of tables.
inline constexpr const char* kTransmittanceFileName = "transmittance.exr";
inline constexpr const char* kSingleScatteringFileName = "single_scattering.exr";
inline constexpr const char* kMultipleScatteringFileName = "multiple_scattering.exr";

/// Use of the tables of a folder, stored in the file of multiple scattering.
struct FolderUse {
  int ray_nodes = 12;  // Gauss nodes per panel of view rays, for all light gathered along them
  /// Tables in the same folder. Quantities without a table are integrated: columns in closed form,
  /// light scattered once on the nodes above.
  bool transmittance = true;
  bool single_scattering = true;

  bool operator==(const FolderUse&) const = default;
};

/// Multiply scattered light as stored in a file.
struct StoredMultipleScattering {
  MultipleScattering light;
  FolderUse use;
};

/// Write the file atomically. Throw OutputError naming the file.
void WriteTable(const std::filesystem::path& file, const TransmittanceTable& table);
void WriteTable(const std::filesystem::path& file, const ScatteringTable& table);
void WriteTable(const std::filesystem::path& file, const MultipleScattering& light,
                const FolderUse& use = {});

/// @param medium_hash  hash of the medium for which the table must have been made; nullopt: any
///   medium.
[[nodiscard]] TransmittanceTable ReadTransmittanceTable(
    const std::filesystem::path& file, const std::optional<std::uint64_t>& medium_hash = {});
[[nodiscard]] ScatteringTable ReadScatteringTable(
    const std::filesystem::path& file, const std::optional<std::uint64_t>& medium_hash = {});
[[nodiscard]] StoredMultipleScattering ReadMultipleScattering(
    const std::filesystem::path& file, const std::optional<std::uint64_t>& medium_hash = {});

/// Description of a file, made after every texel has been checked.
struct TableDescription {
  struct ChannelRange {
    std::string name;
    double lowest, highest, mean;
  };
  std::string kind, quantity, units, axes, axis_sizes, layout, map_version, producer;
  Medium medium;
  std::uint64_t bytes = 0;             // size of the texels
  double lowest = 0.0, highest = 1.0;  // valid range of texels of this kind
  std::vector<ChannelRange> channels;
};
[[nodiscard]] TableDescription DescribeTable(const std::filesystem::path& file);

/// Returns the description for people: one fact per line.
[[nodiscard]] std::string DescriptionText(const std::filesystem::path& file,
                                          const TableDescription& description);

}  // namespace alpenglow::lut
