// SPDX-License-Identifier: MIT
#include "renderer/lit_ground/lit_ground.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"

namespace alpenglow::renderer {
namespace {

/// Runs work that libraries would spread over all processors on one thread, so that drawing keeps
/// the others.
template <typename Work>
auto OnThisThread(const Work& work) {
  tbb::task_arena alone(1);
  return alone.execute(work);
}

LampLight NoLamps(const SceneGround& ground, const Medium& medium) {
  Scene scene;
  scene.place = ground.frame.origin();
  scene.medium = medium;
  return LampLight(scene, ground, medium, BandColour(medium.wavelengths_nm));
}

const Terrain& TerrainOf(const SceneGround& ground) {
  ALPENGLOW_ENSURE(ground.terrain.has_value(), ==, true);
  return *ground.terrain;
}

}  // namespace

SceneGround GroundOf(const ElevationGrid& grid, const LocalFrame& frame) {
  return OnThisThread([&] {
    return SceneGround{frame, Terrain(MeshFromElevation(grid, frame)), 0.0, "", true};
  });
}

GroundSite::GroundSite(SceneGround ground, const GroundCover& cover,
                       std::shared_ptr<const ColourDrape> drape, SolvedAir air)
    : air_(std::move(air)),
      ground_(std::move(ground)),
      geometry_(ground_, medium(), true),
      material_(cover, std::move(drape), medium().wavelengths_nm),
      no_lamps_(NoLamps(ground_, medium())),
      horizons_(ground_, medium()),
      heights_(TerrainOf(ground_).mesh()),
      light_({ground_, geometry_, no_lamps_, horizons_, material_}, air_) {
  ALPENGLOW_ENSURE(ground_.is_one_surface, ==, true);
  OnThisThread([&] { (void)horizons_.Get(); });
}

GroundVertex GroundSite::Vertex(const std::array<float, 3>& position_m,
                                const std::array<float, 3>& normal) const {
  const auto z_m =
      heights_.At(static_cast<double>(position_m[0]), static_cast<double>(position_m[1]));
  return {position_m, normal, z_m ? static_cast<float>(*z_m) : position_m[2]};
}

std::shared_ptr<const TerrainIrradiance> GroundSite::Under(const Lighting& light) const {
  return light_.OnTerrain({light, nullptr});
}

GroundSky::GroundSky(std::shared_ptr<const GroundSite> site, Lighting light)
    : site_(std::move(site)), light_(OnThisThread([&] {
        light.on_terrain = site_->Under(light);
        return std::move(light);
      })) {
  ALPENGLOW_ENSURE(site_->medium().wavelengths_nm.size(), <=, LitVertex{}.sky.size());
}

TerrainIrradiance::OnSlope GroundSky::On(const GroundVertex& vertex) const {
  const SceneGeometry& geometry = site_->geometry();
  const glm::dvec3 point = ToDouble(vertex.position_m);
  const glm::dvec3 up = geometry.UpAt(point);
  const SlopePoint at{point, ToDouble(vertex.normal), up, std::max(geometry.AltitudeOf(point), 0.0),
                      std::clamp(glm::dot(up, light_.source.direction.for_air), -1.0, 1.0)};
  return light_.on_terrain->On(at);
}

LitGround::LitGround(std::shared_ptr<const GroundSite> site, Lighting light,
                     const ShadowHeights::Options& shadow)
    : sky_(std::move(site), std::move(light)), shadow_(OnThisThread([&] {
        return ShadowHeights(sky_.site().ground().terrain->mesh(), lighting().source.direction.seen,
                             lighting().source.radius_rad, shadow);
      })) {}

float LitGround::EdgeOver(const GroundVertex& vertex) const {
  const glm::dvec3 point = ToDouble(vertex.position_m);
  return static_cast<float>(
      shadow_.Over({point.x, point.y, vertex.site_z_m}).Radii(LitVertex::kMostRadii));
}

}  // namespace alpenglow::renderer
