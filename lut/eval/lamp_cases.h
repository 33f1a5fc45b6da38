// SPDX-License-Identifier: MIT
// Cases of lamps in homogeneous air, one a line of a CSV file of their own (CsvReader):
//
//   id,quantity,scattering_per_m,extinction_per_m,phase,g,segment_m,light_along_m,light_across_m,
//   profile,axis_x,axis_y,axis_z,exponent,inner_deg,outer_deg
//
// quantity is airlight. The observer is at the origin and looks along +x; the lamp is at
// (light_along_m, light_across_m, 0); the segment is segment_m long (empty: infinite). phase is
// henyey-greenstein or cornette-shanks; profile iso, cosn (cos^exponent around the axis, 0 behind)
// or cone (1 inside inner_deg, 0 outside outer_deg, between them smoothstep in the cosine). Columns
// that a profile does not use may be empty.
//
// The value is the radiance scattered in along the segment for unit intensity [sr^-1 m^-2], on one
// line a case with wavelength_nm empty; the error is the difference between two numbers of nodes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "atmosphere/lamp/airlight.h"
#include "lut/eval/eval.h"
#include "lut/program/csv_reader.h"

namespace alpenglow::lut {

struct LampCase {
  std::string id;
  LampAir air;
  Lamp lamp;
  LampSegment segment;
};

class LampCaseReader {
 public:
  /// Throws InputError, here and in Next(), for what CsvReader refuses, unknown names, a lamp of no
  /// distance on the segment (a point of light is infinitely bright there), more scattering than
  /// extinction, an axis of length 0.
  explicit LampCaseReader(const std::filesystem::path& file);

  /// The next case, or nothing at the end.
  [[nodiscard]] std::optional<LampCase> Next();

  [[nodiscard]] std::uint64_t bytes_read() const { return lines_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes() const { return lines_.bytes(); }

 private:
  [[nodiscard]] LampAir Air() const;
  [[nodiscard]] Lamp ReadLamp() const;
  void ReadAxis(Lamp& lamp) const;

  CsvReader lines_;
};

/// Whether a file is one of these: its header names light_along_m.
[[nodiscard]] bool HoldsLampCases(const std::filesystem::path& file);

/// By Airlight; with max_error by as many nodes as it takes, and by the judge where 64 do not
/// suffice and for errors below 1e-3.
[[nodiscard]] Estimate EvaluateLamp(const LampCase& work, const IntegralOptions& options);

/// As EvaluateFile, for such a file.
void EvaluateLampFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                      const IntegralOptions& options, ProgressStyle style);

}  // namespace alpenglow::lut
