// SPDX-License-Identifier: MIT
#include "renderer/media/lit_medium.h"

#include <cmath>

namespace alpenglow::renderer {

BandLight MediaSources::SunInAir(const glm::dvec3& point) const {
  const LocalLight here = LocalLightAt(geometry, point, light);
  if (here.visible_fraction <= 0.0) return BandLight(bands());
  return static_cast<float>(here.visible_fraction) *
         air.BeamLeft(here.altitude_m, here.mu_s_effective);
}

BandLight LightOnPoint::LitThrough(const Bands<double>& all_media) const {
  BandLight left(in_air.count);
  for (std::size_t band = 0; band < left.count; ++band)
    left[band] = past_terrain * static_cast<float>(std::exp(-all_media[band]));
  return left;
}

}  // namespace alpenglow::renderer
