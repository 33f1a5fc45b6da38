// SPDX-License-Identifier: MIT
// An eye and one distant light over it, the sun or the moon: what tables of the light that reaches
// an eye depend on, besides the medium. The frame is east, north, up at the eye. Tables begin at the
// azimuth of the light, so that only its elevations matter for them.
#pragma once

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/light_direction.h"
#include "atmosphere/math/constants.h"
#include "lut/layer.h"

namespace alpenglow::lut {

struct EyeUnderLight {
  double altitude_m = 0.0;  // over the sphere of the medium; tables treat values below 0 as 0
  LightDirection light = Unrefracted({0.0, 0.0, 1.0});
  double radius_rad = kSunAngularRadius_rad;  // of the disk of the light

  bool operator==(const EyeUnderLight&) const = default;

  /// Returns the zenith cosine of the light that illuminates the air.
  [[nodiscard]] double mu_s() const { return light.for_air.z; }
  /// Returns the zenith angle at which the disk is seen. Aureoles are centred on it.
  [[nodiscard]] double zenith_angle_seen_rad() const {
    return std::acos(std::clamp(light.seen.z, -1.0, 1.0));
  }
};

}  // namespace alpenglow::lut
