// SPDX-License-Identifier: MIT
#include "viewer/ground/ground_site.h"

#include <utility>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/text/error.h"
#include "viewer/ground/on_this_thread.h"

namespace alpenglow::viewer {
namespace {

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
                       std::shared_ptr<const ColourDrape> drape, SiteAir air)
    : air_(std::move(air)),
      ground_(std::move(ground)),
      geometry_(ground_, medium(), true),
      material_(cover, std::move(drape), medium().wavelengths_nm),
      no_lamps_(NoLamps(ground_, medium())),
      horizons_(ground_, medium()),
      heights_(TerrainOf(ground_).mesh()),
      light_({ground_, geometry_, no_lamps_, horizons_, material_},
             {*air_.integrator, *air_.beam, *air_.diffuse}) {
  ALPENGLOW_ENSURE(ground_.is_one_surface, ==, true);
  OnThisThread([&] { (void)horizons_.Get(); });
}

GroundVertex GroundSite::Vertex(const std::array<float, 3>& position_m,
                                const std::array<float, 3>& normal) const {
  const auto z_m =
      heights_.At(static_cast<double>(position_m[0]), static_cast<double>(position_m[1]));
  return {position_m, normal, z_m ? static_cast<float>(*z_m) : position_m[2]};
}

std::shared_ptr<const TerrainLight> GroundSite::Under(const Lighting& light) const {
  return light_.OnTerrain({light, nullptr});
}

}  // namespace alpenglow::viewer
