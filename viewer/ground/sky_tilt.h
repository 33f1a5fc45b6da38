// SPDX-License-Identifier: MIT
// The light of the open sky on slopes, for the sun of one moment, as a small table.
//
//   E(n) = integral of L(w) max(n.w, 0)   over the directions w above the horizontal
//
// It takes 3 ms on one thread, so that the light of land follows a sun that jumps: vertices keep the share of
// the open sky's light that terrain leaves them. Relief finer than the mesh changes the light in the ratio
// of two slopes under the open sky, too: over rough mountains that is wrong by below 2.1 % rms for
// MountainSurface's relief, which changes the light by 3.0 to 3.8 %.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/dialect/shared_math.h"
#include "renderer/ground/band_light.h"
#include "viewer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "viewer/ground/sky_tilt.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::viewer {

struct SkyTilt {
  static constexpr std::size_t kColumns = 9, kRows = 5;
  /// Irradiance per unit solar irradiance [1] in four bands, row by row; linear between nodes. Those of no
  /// slope, beyond n_sunward^2 + n_up^2 = 1, go on from those of slopes.
  std::array<std::array<float, 4>, kColumns * kRows> nodes{};

  /// @param air, diffuse  of one medium; mu_s: zenith cosine of the sun or moon.
  SkyTilt(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
          double mu_s);

  /// On a slope whose unit normal has these components upwards and towards the sun.
  [[nodiscard]] std::array<float, 4> On(double n_up, double n_sunward) const;
};

}  // namespace alpenglow::viewer
