// SPDX-License-Identifier: MIT
// The light of the open sky on surfaces of any tilt (sky_tilt.glsl), for the sun of one moment.
//
// It takes about a millisecond, so that the light of land follows a sun that jumps: vertices keep the
// share of the open sky's light that terrain leaves them. Relief finer than the mesh changes the light
// in the ratio of two surfaces under the open sky, too: over rough mountains that is wrong by below
// 2.5 % rms for MountainSurface's relief, which changes the light by 2.8 to 3.6 %.
#pragma once

#include <array>

#include "atmosphere/dialect/shared_math.h"
#include "renderer/ground/band_light.h"

namespace alpenglow {

namespace shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "viewer/ground/sky_tilt.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace shared

/// Irradiance per unit solar irradiance [1], by band, over a plain: the terms of OpenSkyOn.
struct SkyTilt {
  BandLight level, up, sunward;

  /// @param air, diffuse  of one medium; mu_s: zenith cosine of the sun or moon.
  SkyTilt(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
          double mu_s);

  /// On a surface whose unit normal has these components upwards and towards the sun.
  [[nodiscard]] std::array<float, 4> On(double n_up, double n_sunward) const;
};

}  // namespace alpenglow
