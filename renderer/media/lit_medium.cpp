// SPDX-License-Identifier: MIT
#include "renderer/media/lit_medium.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::renderer {

Spectrum MediaSources::SunInAir(const glm::dvec3& point) const {
  const LocalLight here = LocalLightAt(geometry, point, light);
  if (here.visible_fraction <= 0.0) return Spectrum(bands());
  return static_cast<float>(here.visible_fraction) *
         air.BeamLeft(here.altitude_m, here.mu_s_effective);
}

LightPastClouds MediaSources::PastClouds(double altitude_m) const {
  return clouds ? clouds(altitude_m) : LightPastClouds::Clear(bands());
}

LightPastClouds LightPastClouds::Clear(std::size_t bands) {
  return {SkyThroughMedia::Clear(bands), SkyThroughMedia::Clear(bands).left, 1.0F};
}

SkyThroughMedia SkyThroughMedia::Clear(std::size_t bands) {
  SkyThroughMedia sky{Spectrum(bands), Spectrum(bands)};
  std::ranges::fill(sky.left.values(), 1.0F);
  return sky;
}

Spectrum LightOnPoint::LitThrough(const SpectrumOf<double>& all_media) const {
  Spectrum left(in_air.size());
  for (std::size_t band = 0; band < left.size(); ++band)
    left[band] = past_terrain * static_cast<float>(std::exp(-all_media[band]));
  return left;
}

}  // namespace alpenglow::renderer
