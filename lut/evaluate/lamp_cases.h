// SPDX-License-Identifier: MIT
// Cases of lamps in homogeneous air, as lines of a separate CSV file (CsvReader):
//
//   id,quantity,scattering_per_m,extinction_per_m,phase,g,segment_m,light_along_m,light_across_m,
//   profile,axis_x,axis_y,axis_z,exponent,inner_deg,outer_deg
//
// quantity is airlight. The observer is at the origin and looks along +x; the lamp is at
// (light_along_m, light_across_m, 0); the segment is segment_m long (empty: infinite). phase is
// henyey-greenstein or cornette-shanks; profile is iso, cosn (cos^exponent around the axis, 0
// behind) or cone (1 inside inner_deg, 0 outside outer_deg, between them smoothstep in the cosine).
// Columns that a profile does not use may be empty.
//
// The value is the radiance scattered into the segment for unit intensity [sr^-1 m^-2], on one line
// per case with wavelength_nm empty; the error is the difference between two numbers of nodes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "atmosphere/base/csv_reader.h"
#include "atmosphere/lamp/airlight.h"
#include "lut/evaluate/eval.h"
#include "lut/evaluate/integral_evaluator.h"

namespace alpenglow::lut {

struct LampCase {
  std::string id;
  std::size_t line = 0;
  LampAir air;
  Lamp lamp;
  LampSegment segment;
};

class LampCaseReader {
 public:
  /// Throws InputError, here and in Next(), for input that CsvReader rejects, unknown names, a lamp
  /// on the segment itself (the radiance of a point source is infinite there), scattering larger
  /// than extinction, or an axis of length 0.
  explicit LampCaseReader(const std::filesystem::path& file);

  /// Returns the next case; std::nullopt at the end.
  [[nodiscard]] std::optional<LampCase> Next();

  /// Throws an InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const {
    lines_.Fail(line, fault);
  }

  [[nodiscard]] std::uint64_t bytes_read() const { return lines_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes() const { return lines_.bytes(); }

 private:
  [[nodiscard]] LampAir Air() const;
  [[nodiscard]] Lamp ReadLamp() const;
  void ReadAxis(Lamp& lamp) const;

  CsvReader lines_;
  CaseIds ids_;
};

/// Returns whether a file contains cases of lamps: its header names light_along_m.
[[nodiscard]] bool HoldsLampCases(const std::filesystem::path& file);

/// Evaluates a case with Airlight. With max_error, the number of nodes is increased as needed; the
/// reference solution is used if 64 nodes do not suffice, and for errors below 1e-3.
[[nodiscard]] Estimate EvaluateLamp(const LampCase& work, const IntegralOptions& options);

/// Evaluates a file of lamp cases like EvaluateFile.
void EvaluateLampFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                      const IntegralOptions& options, ProgressStyle style);

}  // namespace alpenglow::lut
