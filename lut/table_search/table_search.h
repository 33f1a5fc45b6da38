// SPDX-License-Identifier: MIT
// This header provides the search for the smallest tables of an atmosphere whose error lies below a
// bound, for `skylut build --max-error`.
//
// The error of each kind of view (table_views.h) is the rms over its views against the truth of
// these views, plus three standard errors of such a sample, combined with the error of that truth
// itself on a few path-traced views. Both together must lie below the bound for every kind. Moments
// are resampled from one fine solution, so that a table is only as coarse as its grid. The number
// of ray nodes is the smallest whose own error is at most half of the bound (or the bound, if none
// reaches half of it). Tables of transmittance and of single scattering are made only if all tables
// are requested, for programs that need them: closed forms and nodes along the ray need no memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lut/table_search/table_views.h"

namespace alpenglow::lut {

enum class TablesWanted { kSmallest, kAll };

struct TableSearch {
  double max_error = 0.01;  // relative, in (0, 1]
  std::size_t views_of_a_kind = 160;
  std::size_t path_traced_views_of_a_kind = 6;
  TablesWanted wanted = TablesWanted::kSmallest;
};

/// Result of the search, and its errors.
struct TableChoice {
  struct Measured {
    ViewKind kind;
    ErrorStatistics errors;
    ReferenceViews::PathCheck paths;  // check of the truth against path tracing
  };
  TableFolder tables;
  std::uint64_t bytes = 0;  // of all texels
  std::vector<Measured> measured;
};

/// Finds the smallest tables. The result is deterministic. It takes some ten seconds. Throws
/// InputError, with the best error, if no tables reach the bound.
[[nodiscard]] TableChoice ChooseTables(const Medium& medium, const TableSearch& search);
/// Finds the smallest tables from an existing finest solution.
[[nodiscard]] TableChoice ChooseTables(const MultipleScattering& finest, const TableSearch& search);

/// Returns a table with fewer nodes and moments than the solution it is resampled from.
/// @param degree  at most the degree of `light`; InternalError otherwise.
[[nodiscard]] MultipleScattering Resampled(const MultipleScattering& light, int altitudes,
                                           int sun_angles, int degree);

/// Returns sizes, bytes and errors as text.
[[nodiscard]] std::string ChoiceText(const TableChoice& choice, double max_error);

/// Writes the tables of the choice into a folder, which is created if it is missing, and removes
/// tables of an earlier build that the choice does not contain. Throws OutputError.
void WriteTables(const TableChoice& choice, const std::filesystem::path& folder);

}  // namespace alpenglow::lut
