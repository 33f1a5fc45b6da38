// SPDX-License-Identifier: MIT
#include "viewer/ground/lit_ground.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/text/error.h"
#include "viewer/ground/on_this_thread.h"

namespace alpenglow {
namespace {

// At half the height of the land.
SkyTilt TiltUnder(const TerrainLight& light, const glm::dvec3& to_sun) {
  const OpenSky::Extent& extent = light.horizons()->extent();
  return {light.sky(), 0.5 * (extent.lowest_m + extent.highest_m), std::atan2(to_sun.y, to_sun.x),
          to_sun.z};
}

}  // namespace

LitGround::LitGround(std::shared_ptr<const GroundSite> site, Lighting light,
                     const ShadowHeights::Options& shadow)
    : site_(std::move(site)),
      light_(OnThisThread([&] {
        light.on_terrain = site_->Under(light);
        return std::move(light);
      })),
      shadow_(OnThisThread([&] {
        return ShadowHeights(site_->ground().terrain->mesh(), light_.to_sun, light_.sun_radius_rad,
                             shadow);
      })),
      tilt_(TiltUnder(*light_.on_terrain, light_.to_sun)) {
  ALPENGLOW_ENSURE(site_->medium().wavelengths_nm.size(), <=, VertexLight{}.sky.size());
}

VertexLight LitGround::At(const GroundVertex& vertex) const {
  const SceneGeometry& geometry = site_->geometry();
  const glm::dvec3 point = InDoubles(vertex.position_m);
  const glm::dvec3 up = geometry.UpAt(point);
  const double mu_s = std::clamp(glm::dot(up, light_.to_sun), -1.0, 1.0);
  const double altitude_m = std::max(geometry.AltitudeOf(point), 0.0);
  const BandLight sky =
      light_.on_terrain->Irradiance({point, InDoubles(vertex.normal), up, altitude_m, mu_s});
  VertexLight lit{};
  std::copy_n(sky.value.begin(), sky.count, lit.sky.begin());
  lit.sun_x = static_cast<float>(
      shadow_.Over({point.x, point.y, vertex.site_z_m}).Radii(kMostRadii));
  return lit;
}

std::vector<VertexLight> LitGround::LightOf(std::span<const GroundVertex> vertices) const {
  std::vector<VertexLight> lit;
  lit.reserve(vertices.size());
  for (const GroundVertex& vertex : vertices) lit.push_back(At(vertex));
  return lit;
}

}  // namespace alpenglow
