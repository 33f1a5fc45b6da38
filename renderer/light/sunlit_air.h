// SPDX-License-Identifier: MIT
// Air of one medium as ground, fog and volumes in it are lit through it.
#pragma once

#include "atmosphere/ray/bent_beam.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Refers to all three.
struct SunlitAir {
  const AirIntegrator<float>& air;
  const BentBeam& beam;         // of sun and moon themselves
  const DiffuseLight& diffuse;  // of the sky

  /// Returns the irradiance across the beams of a disk whose irradiance above the air is 1. @param mu  see BentBeam::Left.
  [[nodiscard]] Bands<float> BeamLeft(double altitude_m, double mu) const {
    return beam.Left(air, altitude_m, mu);
  }
};

}  // namespace alpenglow::renderer
