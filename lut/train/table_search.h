// SPDX-License-Identifier: MIT
// The smallest tables of an atmosphere whose error lies under a bound: what `skylut build
// --max-error` makes.
//
// The error of each kind of view (table_views.h) is the rms over its views against the truth there,
// with three standard errors of such a sample, and what that truth itself misses of a few
// path-traced views; both together must lie under the bound for every kind. Moments are taken from
// one fine solution, so that a table is only as coarse as its grid; the number of ray nodes is the
// smallest whose own error is half of the bound. Tables of transmittance and of single scattering
// are made only when all are asked for, for programs that want them: closed forms and nodes along
// the ray need no memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lut/train/table_views.h"

namespace alpenglow::lut {

enum class TablesWanted { kSmallest, kAll };

struct TableSearch {
  double max_error = 0.01;  // relative, in (0, 1]
  std::size_t views_of_a_kind = 160;
  std::size_t path_traced_views_of_a_kind = 6;
  TablesWanted wanted = TablesWanted::kSmallest;
};

/// What was found, and how good it is.
struct TableChoice {
  struct Measured {
    ViewKind kind;
    ViewErrors errors;
    JudgedViews::PathCheck paths;  // of the truth that the errors are held against
  };
  TableFolder tables;
  std::uint64_t bytes = 0;  // of all texels
  std::vector<Measured> measured;
};

/// Deterministic. Takes some ten seconds. Throws InputError, with what is best, when no tables
/// reach the bound.
[[nodiscard]] TableChoice ChooseTables(const Medium& medium, const TableSearch& search);
/// The same, from a finest solution that is there already.
[[nodiscard]] TableChoice ChooseTables(const DiffuseLight& finest, const TableSearch& search);

/// A table with fewer nodes and moments than the solution it is taken from.
/// @param degree  at most the degree of `light`; InternalError otherwise.
[[nodiscard]] DiffuseLight Resampled(const DiffuseLight& light, int altitudes, int sun_angles,
                                     int degree);

/// For people: sizes, bytes, errors.
[[nodiscard]] std::string ChoiceText(const TableChoice& choice, double max_error);

/// Writes the tables of the choice into a folder, made when missing, and removes what an earlier
/// build left of those that are not there. Throws OutputError.
void WriteTables(const TableChoice& choice, const std::filesystem::path& folder);

}  // namespace alpenglow::lut
