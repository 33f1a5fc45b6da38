// SPDX-License-Identifier: MIT
// Cases to evaluate, one a line of a CSV file:
//
//   id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m
//
// Columns in any order, all of them, no others, no quotes; distance_m may be empty (to the ground
// or out of the top). Read a line at a time: a file of a million lines needs the memory of one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "atmosphere/ray.h"

namespace alpenglow {

enum class Quantity {
  kTransmittance,    // of the ray [1]
  kOpticalDepth,     // of the ray [1]
  kSingle,           // scattered once, and sunlight from the ground at the end of the ray [1/sr]
  kInscatterSingle,  // scattered once [1/sr]
  kTotal,            // all orders, and light from the ground [1/sr]
  kIrradianceSun,    // of the direct sun on a horizontal plane [1]
  kIrradianceSky,    // of the sky on a horizontal plane [1]
};

struct Case {
  std::string id;
  std::size_t line = 0;
  Quantity quantity = Quantity::kTransmittance;
  ViewRay ray;
};

class CaseReader {
 public:
  /// Opens the file and reads its header. Throws InputError, here and in Next(), naming file, line
  /// and what is wrong: a missing, unknown or repeated column, a field too few or too many, text
  /// that is no number, a value out of range, an unknown quantity, a file without cases.
  explicit CaseReader(const std::filesystem::path& file);

  /// The next case, or nothing at the end.
  [[nodiscard]] std::optional<Case> Next();

  /// An InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const;

  /// How far it is, for progress.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  enum Column { kId, kQuantity, kAltitude, kView, kAzimuth, kSun, kDistance, kColumns };

  [[nodiscard]] bool ReadLine();
  void ReadHeader();
  [[nodiscard]] Case CaseOfLine() const;
  [[nodiscard]] double Number(std::string_view text, Column column, double low, double high) const;

  std::filesystem::path file_;
  std::ifstream stream_;
  std::uint64_t bytes_ = 0;
  std::uint64_t bytes_read_ = 0;
  std::size_t line_number_ = 0;
  std::size_t cases_ = 0;
  std::string line_;
  std::array<std::size_t, kColumns> position_{};  // of each column in the file
};

}  // namespace alpenglow
