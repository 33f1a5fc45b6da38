// SPDX-License-Identifier: MIT
// Q and U of a sky along rows of one zenith angle.
//
// At one zenith angle they are smooth in the azimuth from the sun's, Q an even and U an odd function
// of it: they are evaluated at equal steps over half a turn and go through them as cubics.
#pragma once

#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/diffuse/polarised_light.h"

namespace alpenglow::lut {

/// Of light between an observer and the end of a view, all orders, per unit solar irradiance
/// [1/sr]; the ground's is not polarised. U is positive from the lower left to the upper right, on
/// both sides of the sun.
class PolarisedRow {
 public:
  /// @param mu_s  cosine of the sun's zenith angle at the observer.
  /// `air` and `diffuse` must be of one medium; neither is kept.
  PolarisedRow(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
               double mu_s, double zenith_angle_rad);

  /// @param azimuth_rad  from the sun's, clockwise.
  /// Within 1e-3 of the radiance of what is evaluated there by day, 3e-3 in twilight, up to 10 km.
  [[nodiscard]] PolarisedLight At(double azimuth_rad) const;

 private:
  std::vector<PolarisedLight> nodes_;
};

}  // namespace alpenglow::lut
