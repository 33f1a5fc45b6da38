// SPDX-License-Identifier: MIT
#include "renderer/media/lit_medium.h"

namespace alpenglow::renderer {

BandLight MediaSources::SunInAir(const glm::dvec3& point) const {
  const LocalLight here = LocalLightAt(geometry, point, light);
  if (here.visible_fraction <= 0.0) return BandLight(bands());
  return static_cast<float>(here.visible_fraction) *
         air.BeamLeft(here.altitude_m, here.mu_s_effective);
}

}  // namespace alpenglow::renderer
