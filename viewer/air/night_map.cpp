// SPDX-License-Identifier: MIT
#include "viewer/air/night_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/sun.h"
#include "renderer/light/night_light.h"
#include "viewer/gl/render_target.h"

namespace alpenglow {
namespace {

BandTexel TexelOf(const BandLight& light) {
  BandTexel texel{};
  std::copy_n(light.value.begin(), light.count, texel.begin());
  return texel;
}

glm::vec4 FourOf(const BandLight& light) {
  const BandTexel texel = TexelOf(light);
  return {texel[0], texel[1], texel[2], texel[3]};
}

glm::dvec3 DirectionOf(int column, int row) {
  const double s = 2.0 * row / (NightMap::kRows - 1) - 1.0;
  const double azimuth = 2.0 * kPi * column / (NightMap::kColumns - 1);
  return DirectionFromAngles(0.5 * kPi * s * std::abs(s), azimuth).xyz;
}

void Activate(int unit) { glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit)); }

}  // namespace

NightMap NightMapOf(const NightView& view) {
  const Medium& medium = view.air->medium;
  const NightLight light(NightSky(view.eye, view.now), AirIntegrator<float>(medium),
                         BandColour(medium.wavelengths_nm), {0.0, 0.0, 1.0},
                         std::max(view.eye.height_m, 0.0));
  NightMap map{view, {}, FourOf(light.scattered()), FourOf(light.OnSurface(1.0))};
  map.above.reserve(static_cast<std::size_t>(NightMap::kColumns * NightMap::kRows));
  for (int row = 0; row < NightMap::kRows; ++row) {
    for (int column = 0; column < NightMap::kColumns; ++column)
      map.above.push_back(TexelOf(light.Above(DirectionOf(column, row))));
  }
  return map;
}

bool Serves(const NightMap& map, const NightView& view) {
  constexpr double kTime_s = 60.0, kPlace_m = 20e3, kShareOfHeight = 0.05, kHeight_m = 100.0;
  const double height_m = std::max(map.view.eye.height_m, 0.0);
  const glm::dvec3 off =
      LocalFrame(kWgs84, map.view.eye)
          .EnuFromGeodetic({view.eye.latitude_rad, view.eye.longitude_rad, map.view.eye.height_m})
          .xyz;
  return map.view.air == view.air && std::abs(SecondsBetween(map.view.now, view.now)) < kTime_s &&
         glm::length(off) < kPlace_m &&
         std::abs(view.eye.height_m - height_m) < kHeight_m + kShareOfHeight * height_m;
}

void NightFollower::Take(int unit) {
  std::optional<NightMap> made = job_.Take();
  if (!made) return;
  map_ = std::move(made);
  Activate(unit);
  glBindTexture(GL_TEXTURE_2D, texture_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, NightMap::kColumns, NightMap::kRows, 0, GL_RGBA,
               GL_FLOAT, map_->above.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
}

void NightFollower::Follow(const NightView& view, int unit) {
  Take(unit);
  if (!(map_ && Serves(*map_, view)) && !job_.Busy()) job_.Ask(view);
}

void NightFollower::Settle(const NightView& view, int unit) {
  job_.Wait();
  Take(unit);
  if (map_ && Serves(*map_, view)) return;
  job_.Ask(view);
  job_.Wait();
  Take(unit);
}

void NightFollower::Bind(int unit) const {
  Activate(unit);
  glBindTexture(GL_TEXTURE_2D, texture_.id());
}

}  // namespace alpenglow
