// SPDX-License-Identifier: MIT
// The innermost loop of SkyView: look-ups along a row of four bands, on plain data.
#pragma once

#include <cstddef>
#include <cstdint>

namespace alpenglow {

/// Coefficients of one node: R, M and D of four bands.
inline constexpr std::size_t kSkyNodeFloats = 12;
/// The table of the aerosol's phase function: node k at the scattering angle pi (k / n)^2, k = 0
/// ... n, four bands a node. Linear between nodes it keeps 1e-3 of lobes up to g = 0.99.
inline constexpr int kSkyPhaseNodes = 1024;

struct SkyRowWork {
  const float* row;             // coefficients of the row, kSkyNodeFloats a column
  const float* phase;           // kSkyPhaseNodes + 1 nodes of 4 floats
  const std::int32_t* cell;     // of every look-up: its first column
  const float* weights;         // four a look-up
  const float* half_sine2;      // sin^2 of half the azimuth
  float offset, scale;          // sin^2 of half the angle to the sun: offset + scale half_sine2
  std::size_t count;            // look-ups
  float* radiance;              // four floats a look-up
  std::size_t radiance_stride;  // from one look-up to the next
};

void FillSkyRow(const SkyRowWork& work);

}  // namespace alpenglow
