// SPDX-License-Identifier: MIT
// Single scattering along a ray by direct integration: the same integral as SingleScattering,
// several times as fast, with 7 or 14 nodes in each panel of the ray.
//
// A ray costs one pass over 8 or 16 SIMD lanes. The set-up is scalar (direct_panels.h). Altitude,
// densities and columns are then computed at all nodes at once, without exp, log or ray marching:
// the map of a panel is a polynomial, columns upwards are rational functions with one division
// (optical_depth.glsl), and columns of smooth ozone are polynomials (direct_panels.h). Two
// weightless nodes, at the entry and at the perigee, give the columns from which the columns along
// the ray follow by subtraction.
//
// Error against SingleScattering, relative, rms over the rays of each regime of
// tests/fixtures/direct_regimes.h, all presets:
//
//   fast     0.7 %     7 nodes a panel, 14 in a hard one (earth: 0.39 %)
//   normal   0.07 %   14 nodes a panel; 2 (H/R)^2 or 6e-10 (R/H)^1.5 where these are larger
#pragma once

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/direct_panels.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"

namespace alpenglow::atmosphere {

struct DirectSampling {
  DirectMode mode = DirectMode::kNormal;
  bool dark_samples = false;  // also in the planet's shadow (for multiple scattering)
};

/// Nodes of a ray and the single scattering along them.
struct SampledLight {
  RaySamples<float> samples;
  ScatteredOnce<float> once;
};

/// A medium prepared for direct integration. Immutable, safe to share between threads. Rays are the
/// same as for SingleScattering, whole rays and finite segments, except for segments that lead
/// below altitude 0 (SubmergedPart): direct integration ends them there. Functions throw InputError
/// as ExtentOf does.
class DirectScattering {
 public:
  explicit DirectScattering(const Medium& medium);

  /// Returns the integrator for errors smaller than those of the modes.
  [[nodiscard]] const SingleScattering<float>& reference() const { return reference_; }

  /// Returns the single scattering of direct sunlight along the ray.
  [[nodiscard]] ScatteredOnce<float> Scatter(const ViewRay& ray, DirectMode mode) const;

  /// Returns the nodes of a ray with their weights and columns, for light of any order
  /// (SingleScattering::Scatter of them equals Scatter). Lanes without a node have weight 0.
  [[nodiscard]] RaySamples<float> Sample(const ViewRay& ray, const DirectSampling& sampling) const;

  /// Returns the panels of a ray, for callers that choose DirectRay::few_nodes or weight the nodes
  /// of panels.
  [[nodiscard]] DirectRay Place(const ViewRay& ray, const DirectSampling& sampling) const;
  /// @param sunlight  at the lanes of `placed`; null: unshadowed except by the planet.
  [[nodiscard]] ScatteredOnce<float> Scatter(const DirectRay& placed,
                                             const LaneLight* sunlight) const;
  /// Returns the single scattering together with the nodes; their RaySamples::lit is `sunlight`.
  [[nodiscard]] SampledLight Sample(const DirectRay& placed, const LaneLight* sunlight) const;

  /// Returns the columns from end to end of a ray placed with dark samples [km], without
  /// subtraction, so that short segments lose no digits: within 1e-6 if the altitude changes by
  /// less than six scale heights on each panel, and the panel contains no kink of an ozone tent.
  [[nodiscard]] ColumnSet<float> ColumnsAlong(const DirectRay& placed) const;

 private:
  SingleScattering<float> reference_;
  DirectAir air_;
};

}  // namespace alpenglow::atmosphere
