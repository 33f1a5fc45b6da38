// SPDX-License-Identifier: MIT
// SkyIrradianceGradient tabulates the irradiance of the open sky on slopes for one position of the
// sun:
//
//   E(n) = integral of L(w) max(n.w, 0)   over the directions w above the horizontal
//
// It takes 3 ms on one thread, so that the light of land follows a sun that jumps: vertices store
// the fraction of the open sky's light that reaches them between terrain. Relief finer than the
// mesh also changes the light in the ratio of two slopes under the open sky. Over rough mountains
// the error is below 2.1 % rms for MountainSurface's relief, which changes the light by
// 3.0 to 3.8 %.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/shared_glsl/shared_math.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/illumination/sky_irradiance_gradient.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

struct SkyIrradianceGradient {
  static constexpr std::size_t kColumns = 9, kRows = 5;
  /// Irradiance per unit solar irradiance [1] in four bands, row by row; linear between nodes.
  /// Nodes beyond n_sunward^2 + n_up^2 = 1 belong to no slope and are extrapolated from slopes.
  std::array<std::array<float, 4>, kColumns * kRows> nodes{};

  /// @param air, multiple_scattering  of one medium; mu_s: zenith cosine of the sun or moon.
  SkyIrradianceGradient(const SingleScattering<float>& air,
                        const MultipleScattering& multiple_scattering, double altitude_m,
                        double mu_s);

  /// Returns the irradiance on a slope whose unit normal has these components upwards and towards
  /// the sun.
  [[nodiscard]] std::array<float, 4> On(double n_up, double n_sunward) const;
};

}  // namespace alpenglow::renderer
