// SPDX-License-Identifier: MIT
// This header provides a folder of the tables of one atmosphere: writing, reading and describing
// it.
//
// It also provides light along rays from the tables of a folder. Quantities without a table are
// integrated: columns in closed form, light scattered once on the folder's number of Gauss nodes.
//
// Segments that end in the air are integrated too, because the difference of two look-ups would
// have the error of whole rays.
//
// All values are per unit solar irradiance. Light of higher orders is gathered along the ray from
// the moments of multiple scattering, on the same nodes as light scattered once.
#pragma once

#include <alpenglow/tables.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "lut/table_io/table_file.h"

namespace alpenglow::lut {

/// Sizes of the tables of a BakeQuality.
struct TableSizes {
  TransmittanceTableSize transmittance;
  ScatteringTableSize single_scattering;
  MultipleScatteringOptions multiple_scattering;  // in clear air; see RaisedFor
  int ray_nodes = 12;
};

/// Parses "preview", "standard" or "fine"; throws InputError for another name.
[[nodiscard]] BakeQuality BakeQualityFromName(std::string_view name);

/// Returns the sizes of a quality. Throws InputError for a value that is none of the enumeration's.
[[nodiscard]] TableSizes SizesOf(BakeQuality quality);

/// Builds and writes the tables, each file atomically; creates the folder if it is missing. Throws
/// OutputError naming the file that could not be written.
/// @param row_done  is called after each row of single scattering, from any thread; an exception
///   ends the work.
void BuildTableFolder(const Medium& medium, const BakeOptions& options,
                      const std::filesystem::path& folder, const std::function<void()>& row_done);

/// Tables of one medium. Quantities without a table are integrated where they are needed (see
/// FolderUse).
struct TableFolder {
  Medium medium;
  std::optional<TransmittanceTable> transmittance;
  std::optional<ScatteringTable> single_scattering;
  std::optional<MultipleScattering> multiple_scattering;
  int ray_nodes = 12;
};

/// Reads the tables that the file of multiple scattering lists; the other two if that file is
/// missing. Throws InputError if one of them is missing or bad, if they do not belong to the medium
/// of medium_hash, or if they belong to different media.
[[nodiscard]] TableFolder ReadTableFolder(const std::filesystem::path& folder,
                                          const std::optional<std::uint64_t>& medium_hash = {});

/// Returns DescriptionText of a table, or of every table in a folder. Throws InputError if there is
/// none.
[[nodiscard]] std::string DescribeTables(const std::filesystem::path& file_or_folder);

/// Look-ups in the tables of a folder. Safe from many threads.
class TableLookup {
 public:
  /// Throws InputError for tables of different media.
  explicit TableLookup(TableFolder tables);

  /// Replaces the table of multiple scattering by another one of the same medium.
  void ReplaceMultipleScattering(MultipleScattering light);

  [[nodiscard]] const Medium& medium() const { return tables_.medium; }
  [[nodiscard]] const TableFolder& tables() const { return tables_; }
  /// Returns the air that integrates what has no table.
  [[nodiscard]] const SingleScattering<float>& single_scattering() const { return air_; }
  /// Throws InternalError for tables of single scattering only.
  [[nodiscard]] const MultipleScattering& multiple_scattering() const;
  [[nodiscard]] std::size_t bands() const { return air_.bands(); }

  /// Return transmittance and optical depth to the end of the ray.
  [[nodiscard]] Spectrum Transmittance(const ViewRay& ray) const;
  [[nodiscard]] Spectrum OpticalDepth(const ViewRay& ray) const;
  /// Return the light that the air along the ray scatters towards the observer [1/sr]: once, and in
  /// all orders (which needs the table of multiple scattering).
  [[nodiscard]] Spectrum InscatterOnce(const ViewRay& ray) const;
  [[nodiscard]] Spectrum InscatterOfAllOrders(const ViewRay& ray) const;
  /// Returns Q and U of InscatterOfAllOrders; 0 if light is not polarised.
  [[nodiscard]] PolarisedLight PolarisationOfAllOrders(const ViewRay& ray) const;
  /// Return the irradiance on a horizontal plane [1]: the sun's, and the sky's (needs multiple
  /// scattering).
  [[nodiscard]] Spectrum SunIrradiance(double altitude_m, double mu_s) const;
  [[nodiscard]] Spectrum SkyIrradiance(double altitude_m, double mu_s) const;

 private:
  [[nodiscard]] bool HasTableFor(const ViewRay& ray) const;
  [[nodiscard]] bool HasTransmittanceFor(const ViewRay& ray) const;

  TableFolder tables_;
  SingleScattering<float> air_;
};

}  // namespace alpenglow::lut
