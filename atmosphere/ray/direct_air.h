// SPDX-License-Identifier: MIT
// A medium prepared for direct integration (direct_scattering.h): the constants of
// direct_columns.glsl for each layer, and the columns of smooth ozone as polynomials.
//
//   (|mu| + k) column(h, mu) = sum over a, q of  c_qa Y^a U^q,   a <= 12, q <= 5
//   Y = 2 min(h, top) / top - 1,   U = 2 (1 + k) |mu| / (|mu| + k) - 1,   k = 0.12
//
// Lengths are in km. Extinctions carry a factor log2(e), because kernels use powers of two.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray_samples.h"

namespace alpenglow::atmosphere {

/// An exponential layer of scale height H over a planet of radius R.
struct DirectLayer {
  float per_height;     // -log2(e) / H
  float root;           // sqrt(1 / 2H)
  float delta;          // 5/8 H/R
  float up_scale;       // share H (1 + H/R) root
  float perigee_scale;  // share sqrt(pi) H (1 + 3/8 H/R) root
  float beyond_scale;   // up_scale exp(-top/H) sqrt(R + top): column above the top
  float beyond_root;    // root sqrt(R + top)
};

inline constexpr std::size_t kOzoneHeights = 13;  // powers of Y
inline constexpr std::size_t kOzoneCosines = 6;   // powers of U
inline constexpr float kOzoneCosine = 0.12F;      // k

/// The polynomials of a smooth layer of ozone [km].
struct OzoneFit {
  std::array<std::array<float, kOzoneHeights>, kOzoneCosines> up;  // [q][a]
  std::array<float, kOzoneHeights> perigee;                        // column along mu = 0
};

struct DirectAir {
  double radius, top;
  DirectLayer rayleigh, deficit, mie;
  float deficit_share;  // d of MoleculeDeficit
  bool has_deficit, has_ozone, smooth_ozone;
  bool reaches_top;  // the columns above the top count
  float ozone_bottom, ozone_peak, ozone_top;
  OzoneFit ozone_fit;
  float largest_extinction;  // of molecules and aerosol at altitude 0 [1/km]
  double least_error;        // relative, of light through these columns in single precision
  std::size_t bands;
  std::array<float, kMaxBands> rayleigh_extinction, mie_extinction, ozone_extinction;  // log2(e)/km
  std::array<float, kMaxBands> rayleigh_scattering, mie_scattering;                    // 1/km
};

/// Takes 0.1 ms for a smooth layer of ozone.
[[nodiscard]] DirectAir DirectAirOf(const Medium& medium);

}  // namespace alpenglow::atmosphere
