// SPDX-License-Identifier: MIT
// A folder of the tables of one atmosphere: made, read, described.
//
// Light along rays from the tables of a folder; what they leave out is integrated: columns in
// closed form, light scattered once on the folder's number of Gauss nodes.
//
// Segments that end in the air are integrated, too: the difference of two look-ups would have the
// error of whole rays.
//
// Per unit solar irradiance. Light of higher orders is gathered along the ray from the moments of
// multiple scattering, on the same nodes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lut/program/messages.h"
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

/// Safe from many threads.
class TableLookup {
 public:
  /// Throws InputError for tables of different media.
  explicit TableLookup(TableFolder tables);

  /// Takes another table of multiple scattering, of the same medium.
  void ReplaceMultipleScattering(DiffuseLight light);

  [[nodiscard]] const Medium& medium() const { return tables_.medium; }
  [[nodiscard]] const TableFolder& tables() const { return tables_; }
  [[nodiscard]] std::size_t bands() const { return air_.bands(); }

  /// To the end of the ray.
  [[nodiscard]] Bands<float> Transmittance(const ViewRay& ray) const;
  [[nodiscard]] Bands<float> OpticalDepth(const ViewRay& ray) const;
  /// Light that the air of the ray scatters towards the observer [1/sr]: once, and in all orders
  /// (which needs the table of multiple scattering).
  [[nodiscard]] Bands<float> InscatterOnce(const ViewRay& ray) const;
  [[nodiscard]] Bands<float> InscatterOfAllOrders(const ViewRay& ray) const;
  /// Its Q and U; 0 where light is not polarised.
  [[nodiscard]] PolarisedLight PolarisationOfAllOrders(const ViewRay& ray) const;
  /// On a horizontal plane [1]: the sun's, and the sky's (needs multiple scattering).
  [[nodiscard]] Bands<float> SunIrradiance(double altitude_m, double mu_s) const;
  [[nodiscard]] Bands<float> SkyIrradiance(double altitude_m, double mu_s) const;

 private:
  [[nodiscard]] const DiffuseLight& diffuse() const;
  [[nodiscard]] bool HasTableFor(const ViewRay& ray) const;

  TableFolder tables_;
  AirIntegrator<float> air_;
};

}  // namespace alpenglow::lut
