// SPDX-License-Identifier: MIT
// Light along rays from the tables of a folder; what they leave out is integrated: columns in
// closed form, light scattered once on the folder's number of Gauss nodes.
//
// Segments that end in the air are integrated, too: the difference of two look-ups would have the
// error of whole rays.
//
// Per unit solar irradiance. Light of higher orders is gathered along the ray from the moments of
// multiple scattering, on the same nodes.
#pragma once

#include "lut/store/table_folder.h"

namespace alpenglow::lut {

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
