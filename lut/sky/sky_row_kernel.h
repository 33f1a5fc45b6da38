// SPDX-License-Identifier: MIT
// The innermost loop of SkyView, one table per instruction set: look-ups along a row of four bands.
#pragma once

#include <cstddef>
#include <cstdint>

#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Number of terms M of aerosol with a separate forward peak: light scattered once, and the peak
/// by depth. A narrow backward lobe adds another term. Otherwise there is one term.
inline constexpr std::size_t kSkyPeakTerms = 6;
inline constexpr std::size_t kSkyLobeTerms = kSkyPeakTerms + 1;
/// Returns the number of coefficients of one node: R, D and every M of four bands.
[[nodiscard]] constexpr std::size_t SkyNodeFloats(std::size_t terms) { return 8 + 4 * terms; }
/// Size of the table of the phase functions of the terms: node k is at the scattering angle
/// pi (k / n)^2, k = 0 ... n, with all terms of four bands per node, linear between nodes.
inline constexpr int kSkyPhaseNodes = 1024;

struct SkyRowWork {
  std::size_t terms;            // of aerosol: 1, kSkyPeakTerms or kSkyLobeTerms
  const float* row;             // coefficients of the row, SkyNodeFloats(terms) per column
  const float* phase;           // kSkyPhaseNodes + 1 nodes of 4 floats for every term
  const std::int32_t* cell;     // first column of every look-up
  const float* weights;         // four per look-up
  const float* half_sine2;      // sin^2 of half the azimuth
  float offset, scale;          // sin^2 of half the angle to the sun: offset + scale half_sine2
  std::size_t count;            // number of look-ups
  float* radiance;              // four floats per look-up
  std::size_t radiance_stride;  // distance from one look-up to the next
};

/// Weighted sum of four rows of `count` floats, `stride` apart.
struct SkyBlendWork {
  const float* rows;
  std::size_t stride, count;
  const float* weights;
  float* sum;
};

struct SkyRowKernel {
  void (*fill)(const SkyRowWork& work);
  void (*blend)(const SkyBlendWork& work);
};

ALPENGLOW_DECLARE_KERNEL(SkyRowKernel);

}  // namespace alpenglow::lut
