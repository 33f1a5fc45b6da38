// SPDX-License-Identifier: MIT
// The axes of DiffuseLight's table, outside of kernels.
#pragma once

#include "atmosphere/air/medium.h"
#include "lut/diffuse/diffuse_kernel.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/diffuse/polarised_light.h"
#include "lut/table/cubic_taps.h"

namespace alpenglow::lut {

[[nodiscard]] DiffuseGrid GridOf(const Medium& medium, const DiffuseLightOptions& options);

/// What moments are divided by before they are interpolated between sun angles, in (0, 1].
[[nodiscard]] float TwilightOf(const DiffuseGrid& grid, double mu_s);

/// Sun nodes around mu_s and their weights, for moments as they are (not divided by TwilightOf).
[[nodiscard]] CubicTaps SunTaps(const DiffuseGrid& grid, double mu_s);

/// TwilightOf at every sun node.
[[nodiscard]] std::vector<float> TwilightAtNodes(const DiffuseGrid& grid);

/// The molecules' Legendre coefficient of degree 2: D / 10.
[[nodiscard]] float RayleighChi2(const Medium& medium, std::size_t band);

/// Zenith cosine of a sun node: on DiffuseLight::SunNodes(), but that of polarised light beside the
/// zenith.
[[nodiscard]] double MuSOfNode(const DiffuseGrid& grid, std::size_t sun);

/// The sine of an angle in [0, pi] from its cosine.
[[nodiscard]] double SineOf(double cosine);
/// Sine of the sun's zenith angle.
[[nodiscard]] float SunSine(double mu_s);

/// By what a moment of order m is to be multiplied after it was divided at a node: SinePower of
/// polarised light, else 1.
[[nodiscard]] inline float SinePowerOf(const DiffuseGrid& grid, std::size_t m, float sun_sine) {
  return grid.polarised ? SinePower(m, sun_sine) : 1.0F;
}

/// Where moment (l, m) of a band of the block begins in a packed node.
[[nodiscard]] constexpr std::size_t PackedIndex(std::size_t l, std::size_t m) {
  return (kPackedRow[l] + m / 2) * 8 + (m % 2) * kBlockBands;
}

/// Where T2m of a band of the block begins in a packed node; where moment 00 is repeated.
[[nodiscard]] constexpr std::size_t PackedTensorIndex(std::size_t degree, std::size_t m) {
  return (kPackedRow[degree + 1] + m / 2) * 8 + (m % 2) * kBlockBands;
}
[[nodiscard]] constexpr std::size_t PackedTensorTrace(std::size_t degree) {
  return PackedTensorIndex(degree, 3);
}

}  // namespace alpenglow::lut
