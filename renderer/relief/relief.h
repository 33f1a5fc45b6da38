// SPDX-License-Identifier: MIT
// This header provides relief and cover of the ground finer than an elevation model, as one
// function of a place and of the width of the ground that is seen as one (the footprint).
//
//   gullies   octaves of stripes along the fall line, each along that of the octaves before
//   rock      gullies with sharp crests, bands of strata, crags
//   debris    soft forms, and a thickness that ends at the angle of repose
//   snow      a depth that fills hollows and couloirs
//
// The ground is the highest of rock, debris and snow, which alone draws crisp borders that follow
// the relief. Relief below the footprint has a variance v instead of a form: the highest layer
// becomes shares Phi(difference / sqrt(v)), and the height the mean of the larger one (Clark 1961,
// Operations Research 9, 145). The mean height and the mean shares therefore hardly depend on the
// footprint. An octave that the model itself has is left out, by the spacing of its samples.
//
// Sources of the forms: Lovejoy et al. (1995), Nonlinear Processes in Geophysics 2, 16 (spectra of
// mountains, power ~ wavelength^2); Perron, Kirchner, Dietrich (2008), J. Geophys. Res. 113, F04003
// (soil is smooth below the length of hillslopes). The formulas are in relief_forms.glsl, which
// shaders can read, the loops in relief.cpp. Used by the study and tests so far.
//
// Units are metres; slopes are tangents.
#pragma once

#include <cstdint>

#include "renderer/layer.h"
#include "renderer/material/land_cover.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/relief/relief_forms.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// A place in the plane of the pattern: whole blocks of kBlock_m to the east and north, and the
/// rest in [0, kBlock_m), which float resolves to 0.06 mm everywhere.
template <typename Real>
struct BlockPlace {
  std::int32_t east_block = 0, north_block = 0;
  Real east_m{}, north_m{};
};

/// Returns the blocks of a place within 2^40 m of the origin.
template <typename Real>
[[nodiscard]] BlockPlace<Real> BlockPlaceOf(double east_m, double north_m);

/// An elevation model at a place: height and derivatives, without voids.
template <typename Real>
struct ModelAt {
  Real height_m{};
  Real slope_east{}, slope_north{};
  Real bend_east_per_m{}, bend_across_per_m{}, bend_north_per_m{};  // second derivatives
};

struct ReliefScale {
  double spacing_m = 90.0;   // of the model's samples; positive
  double footprint_m = 2.0;  // positive; relief ends at cells of 2 m
};

/// Shares of surfaces, each in [0, 1], with the sum 1.
template <typename Real>
struct SurfaceShares {
  Real bedrock{}, scree{}, meadow{}, forest{}, snow{};
};

/// Ground at a place: its height above the model, its gradient, and what covers it.
template <typename Real>
struct Relief {
  Real height_m{};
  Real slope_east{}, slope_north{};  // of model and relief together
  SurfaceShares<Real> shares;
};

/// Returns relief without its gradient: slopes are those of the model. Defined for float and
/// double. With models of 0.5 m and finer the height is exactly 0. The height is between -160 and
/// 160 m; for the largest spacings the longest waves are of 602 m, so that a model of 1 km keeps a
/// gap between them and its own. Float differs from double by at most 3 mm within 50 km.
template <typename Real>
[[nodiscard]] Relief<Real> ReliefAt(const BlockPlace<Real>& place, const ModelAt<Real>& model,
                                    const MountainCover& cover, const ReliefScale& scale);

/// Returns the same with the gradient of model and relief, at about twice the time. Third
/// derivatives of the model are neglected: they change the slope by at most 0.05 on a model with
/// bends of 0.015 / m.
template <typename Real>
[[nodiscard]] Relief<Real> SlopedReliefAt(const BlockPlace<Real>& place, const ModelAt<Real>& model,
                                          const MountainCover& cover, const ReliefScale& scale);

}  // namespace alpenglow::renderer
