// SPDX-License-Identifier: MIT
// This header provides the axes of MultipleScattering's table to code outside the kernels.
#pragma once

#include "atmosphere/medium/medium.h"
#include "lut/multiple_scattering/moment_kernel.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {

[[nodiscard]] MomentGrid GridOf(const Medium& medium, const MultipleScatteringOptions& options);

/// Returns the medium in which the moments are transported: without the forward peak if
/// MultipleScatteringOptions::delta_m is set.
[[nodiscard]] DeltaScaledMedium ScatteringMedium(const Medium& medium,
                                                 const MultipleScatteringOptions& options);

/// Returns the divisor of moments before they are interpolated between sun angles, in (0, 1].
[[nodiscard]] float TwilightOf(const MomentGrid& grid, double mu_s);

/// Returns the sun nodes around mu_s and their weights, for moments that are not divided by
/// TwilightOf.
[[nodiscard]] CubicTaps SunTaps(const MomentGrid& grid, double mu_s);

/// Returns TwilightOf at every sun node.
[[nodiscard]] std::vector<float> TwilightAtNodes(const MomentGrid& grid);

/// Returns the molecules' Legendre coefficient of degree 2: D / 10.
[[nodiscard]] float RayleighChi2(const Medium& medium, std::size_t band);

/// Returns the coefficients of the four bands from first_band on; 0 where the medium has fewer.
/// @param chi  of the aerosol: degree l of a band at [l * bands + band].
[[nodiscard]] BlockShape ShapeOfBlock(const Medium& medium, const std::vector<double>& chi,
                                      std::size_t degree, std::size_t first_band);

/// Returns the zenith cosine of a sun node. The nodes are those of MultipleScattering::SunNodes(),
/// except that for polarised light the last one lies close to the zenith.
[[nodiscard]] double MuSOfNode(const MomentGrid& grid, std::size_t sun);

/// Returns the sine of an angle in [0, pi] from its cosine.
[[nodiscard]] double SineOf(double cosine);
/// Returns the sine of the sun's zenith angle.
[[nodiscard]] float SunSine(double mu_s);

/// Returns the factor that restores a moment of order m which was divided at a node: SinePower for
/// polarised light, else 1.
[[nodiscard]] inline float SinePowerOf(const MomentGrid& grid, std::size_t m, float sun_sine) {
  return grid.polarised ? SinePower(m, sun_sine) : 1.0F;
}

/// Returns the index at which moment (l, m) of a block's bands begins in a packed node.
[[nodiscard]] constexpr std::size_t PackedIndex(std::size_t l, std::size_t m) {
  return (kPackedRow[l] + m / 2) * 8 + (m % 2) * kBlockBands;
}

/// Return the indices at which T2m of a block's bands, and the copy of moment 00, begin in a packed
/// node.
[[nodiscard]] constexpr std::size_t PackedTensorIndex(std::size_t degree, std::size_t m) {
  return (kPackedRow[degree + 1] + m / 2) * 8 + (m % 2) * kBlockBands;
}
[[nodiscard]] constexpr std::size_t PackedTensorTrace(std::size_t degree) {
  return PackedTensorIndex(degree, 3);
}

}  // namespace alpenglow::lut
