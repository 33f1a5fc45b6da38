// SPDX-License-Identifier: MIT
// How the light of the sky on a surface changes when it tilts a little: relief finer than the mesh
// against the mesh.
//
//   E(n) = level + up n.up + sunward n.s,     s the horizontal direction towards the sun
//
// fitted to the open sky over a plain for surfaces up to 60 degrees steep. Where terrain hides a
// part of the sky the ratio of two surfaces is taken to be the same: over rough mountains that is
// wrong by below 2.5 % rms for MountainSurface's relief, which changes the light by 2.8 to 3.6 %.
#pragma once

#include "renderer/ground/band_light.h"
#include "renderer/light/open_sky.h"

namespace alpenglow {

/// Irradiance per unit solar irradiance [1], by band.
struct SkyTilt {
  BandLight level, up, sunward;

  /// @param sun_azimuth_rad  counter-clockwise from east; mu_s: zenith cosine of the sun.
  SkyTilt(const OpenSky& sky, double altitude_m, double sun_azimuth_rad, double mu_s);
};

}  // namespace alpenglow
