// SPDX-License-Identifier: MIT
// Cases to evaluate, one a line of a CSV file:
//
//   id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m
//
// as CsvReader reads them. distance_m empty: the ray goes to the ground, whose light it brings, or
// out of the top. Given: the segment stops there, or at the ground or the top if nearer, and light
// that the ground reflects is left out even where the segment reaches it. relative_azimuth_deg in
// (0, 180): the sun is to the left of the view, beyond (and below 0) to its right, which is another
// sign of stokes_u. Cases of lamps have columns of their own: lamp_cases.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "atmosphere/ray/ray.h"
#include "lut/layer.h"
#include "lut/program/csv_reader.h"

namespace alpenglow::lut {

enum class Quantity {
  kTransmittance,    // of the ray [1]
  kOpticalDepth,     // of the ray [1]
  kSingle,           // scattered once, and sunlight from the ground at the end of the ray [1/sr]
  kInscatterSingle,  // scattered once [1/sr]
  kTotal,            // all orders, and light from the ground at the end of the ray [1/sr]
  kStokesQ,          // of all orders, as PolarisedLight [1/sr]
  kStokesU,
  kIrradianceSun,  // of the direct sun on a horizontal plane [1]
  kIrradianceSky,  // of the sky on a horizontal plane [1]
};

struct Case {
  std::string id;
  std::size_t line = 0;
  Quantity quantity = Quantity::kTransmittance;
  ViewRay ray;
  double relative_azimuth_deg = 0.0;
};

class CaseReader {
 public:
  /// Throws InputError, here and in Next(), for what CsvReader refuses and an unknown quantity.
  explicit CaseReader(const std::filesystem::path& file);

  /// The next case, or nothing at the end.
  [[nodiscard]] std::optional<Case> Next();

  /// An InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const {
    lines_.Fail(line, fault);
  }

  /// How far it is, for progress.
  [[nodiscard]] std::uint64_t bytes_read() const { return lines_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes() const { return lines_.bytes(); }

 private:
  CsvReader lines_;
};

}  // namespace alpenglow::lut
