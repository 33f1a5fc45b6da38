// SPDX-License-Identifier: MIT
// Views that tables are measured on, and what is to be seen there.
//
// Four kinds: the sky by day (sun 2 to 90 degrees high), aerial perspective (segments of 0.5 to
// 100 km by day), the sky in twilight (sun 2 degrees above to 6 below the horizon), and the sky's
// irradiance on horizontal planes (sun -6 to 90 degrees); observers from 2 m to 10 km. The truth of
// a view is the judge's single scattering and transmittance, and a solution of the diffuse light
// that is finer than any table; HeldAgainstPaths holds that truth against the path tracer.
//
// The error of a view: |difference| over |truth|, lengths of vectors over the bands; and the
// largest difference of transmittance where that is larger.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "lut/diffuse/multiple_scattering.h"
#include "lut/store/table_folder.h"

namespace alpenglow::lut {

enum class ViewKind { kSky, kAerialPerspective, kTwilight, kIrradiance };
inline constexpr std::array kViewKinds{ViewKind::kSky, ViewKind::kAerialPerspective,
                                       ViewKind::kTwilight, ViewKind::kIrradiance};
[[nodiscard]] std::string_view NameOf(ViewKind kind);

/// The finest solution: what the moments of tables are taken from and held against. Takes seconds.
[[nodiscard]] DiffuseLight FinestDiffuseLight(const Medium& medium);

struct JudgedView {
  ViewKind kind;
  ViewRay ray;  // of irradiance only the altitude and mu_s
  std::vector<double> light;
  std::vector<double> transmittance;  // empty for irradiance
};

/// The errors of the views of one kind.
struct ViewErrors {
  double rms = 0.0;  // of these views
  /// The root of the mean square plus three standard errors of it. Of 160 errors, the rms of the
  /// whole kind lies below this in 99 % of samples of a normal and 97 % of an exponential law.
  double rms_at_most = 0.0;
  double percentile_99 = 0.0;
};
/// @param errors  relative errors of single views, in any order; one at least.
[[nodiscard]] ViewErrors ErrorsOfViews(std::vector<double> errors);

/// Truths for a set of views; the same for any number of threads.
class JudgedViews {
 public:
  /// @param first  number of the first view of a low-discrepancy sequence: sets [first, first +
  /// views_of_a_kind) that do not overlap have no view in common.
  JudgedViews(const Medium& medium, const DiffuseLight& finest, std::size_t views_of_a_kind,
              std::size_t first);

  [[nodiscard]] const std::vector<JudgedView>& views() const { return views_; }
  [[nodiscard]] ViewErrors ErrorsOf(const TableLookup& tables, ViewKind kind) const;

  /// The truth itself against paths, on views of a kind spread over the set.
  struct PathCheck {
    double rms = 0.0;
    double noise = 0.0;  // rms of the standard errors of the paths
    /// What of the rms the noise does not explain.
    [[nodiscard]] double Unexplained() const;
  };
  [[nodiscard]] PathCheck HeldAgainstPaths(const Medium& medium, ViewKind kind, std::size_t views,
                                           double standard_error) const;

 private:
  std::vector<JudgedView> views_;
};

}  // namespace alpenglow::lut
