// SPDX-License-Identifier: MIT
// This header provides the views on which tables are measured, and their true values.
//
// There are four kinds: the sky by day (sun 2 to 90 degrees high), aerial perspective (segments of
// 0.5 to 100 km by day), the sky in twilight (sun 2 degrees above to 6 below the horizon), and the
// sky's irradiance on horizontal planes (sun -6 to 90 degrees); observers from 2 m to 10 km. The
// truth of a view consists of the reference solution's single scattering and transmittance, and of
// a solution of the multiply scattered light that is finer than any table. HeldAgainstPaths
// compares that truth with the path tracer.
//
// The error of a view is |difference| over |truth|, lengths of vectors over the bands, or the
// largest difference of transmittance if that is larger.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "atmosphere/math/error_statistics.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow::lut {

enum class ViewKind { kSky, kAerialPerspective, kTwilight, kIrradiance };
inline constexpr std::array kViewKinds{ViewKind::kSky, ViewKind::kAerialPerspective,
                                       ViewKind::kTwilight, ViewKind::kIrradiance};
[[nodiscard]] std::string_view NameOf(ViewKind kind);

/// Returns the finest solution, from which the moments of tables are resampled and with which they
/// are compared. It takes seconds.
[[nodiscard]] MultipleScattering FinestMultipleScattering(const Medium& medium);

struct ReferenceView {
  ViewKind kind;
  ViewRay ray;  // for irradiance only the altitude and mu_s are used
  std::vector<double> light;
  std::vector<double> transmittance;  // empty for irradiance
};

/// True values for a set of views. They do not depend on the number of threads.
class ReferenceViews {
 public:
  /// @param first  number of the first view of a low-discrepancy sequence: sets [first, first +
  ///   views_of_a_kind) that do not overlap have no view in common.
  ReferenceViews(const Medium& medium, const MultipleScattering& finest,
                 std::size_t views_of_a_kind, std::size_t first);

  [[nodiscard]] const std::vector<ReferenceView>& views() const { return views_; }
  [[nodiscard]] ErrorStatistics ErrorsOf(const TableLookup& tables, ViewKind kind) const;

  /// Comparison of the truth with path tracing, on views of a kind spread over the set.
  struct PathCheck {
    double rms = 0.0;
    double noise = 0.0;  // rms of the standard errors of the paths
    /// Returns the part of the rms that the noise does not explain.
    [[nodiscard]] double Unexplained() const;
  };
  [[nodiscard]] PathCheck HeldAgainstPaths(const Medium& medium, ViewKind kind, std::size_t views,
                                           double standard_error) const;

 private:
  std::vector<ReferenceView> views_;
};

}  // namespace alpenglow::lut
