// SPDX-License-Identifier: MIT
// The axes of DiffuseLight's table, outside of kernels.
#pragma once

#include "atmosphere/air/medium.h"
#include "lut/diffuse/diffuse_kernel.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/table/cubic_taps.h"

namespace alpenglow {

[[nodiscard]] DiffuseGrid GridOf(const Medium& medium, const DiffuseLightOptions& options);

/// What moments are divided by before they are interpolated between sun angles, in (0, 1].
[[nodiscard]] float TwilightOf(const DiffuseGrid& grid, double mu_s);

/// Sun nodes around mu_s and their weights, for moments as they are (not divided by TwilightOf).
[[nodiscard]] CubicTaps SunTaps(const DiffuseGrid& grid, double mu_s);

/// TwilightOf at every sun node.
[[nodiscard]] std::vector<float> TwilightAtNodes(const DiffuseGrid& grid);

/// Where moment (l, m) of a band of the block begins in a packed node.
[[nodiscard]] constexpr std::size_t PackedIndex(std::size_t l, std::size_t m) {
  return (kPackedRow[l] + m / 2) * 8 + (m % 2) * kBlockBands;
}

}  // namespace alpenglow
