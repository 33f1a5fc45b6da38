// SPDX-License-Identifier: MIT
#include "viewer/ground/ground_site.h"

#include <utility>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/text/error.h"
#include "viewer/ground/on_this_thread.h"

namespace alpenglow {
namespace {

LampLight NoLamps(const SceneGround& ground, const Medium& medium) {
  Scene scene;
  scene.place = ground.frame.origin();
  scene.medium = medium;
  return LampLight(scene, ground, medium, BandColour(medium.wavelengths_nm));
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
      light_({ground_, geometry_, no_lamps_, horizons_, material_}, *air_.integrator,
             *air_.diffuse) {
  ALPENGLOW_ENSURE(ground_.terrain.has_value(), ==, true);
  ALPENGLOW_ENSURE(ground_.is_one_surface, ==, true);
  OnThisThread([&] { (void)horizons_.Get(); });
}

GroundVertex GroundSite::Vertex(const std::array<float, 3>& position_m,
                                const std::array<float, 3>& normal) const {
  constexpr double kAbove_m = 20000.0;
  const glm::dvec3 point = InDoubles(position_m);
  const auto hit = ground_.terrain->Intersect({point.x, point.y, kAbove_m}, {0.0, 0.0, -1.0});
  return {position_m, normal, hit ? static_cast<float>(kAbove_m - hit->distance_m) : position_m[2]};
}

std::shared_ptr<const TerrainLight> GroundSite::Under(const Lighting& light) const {
  return light_.OnTerrain({light, nullptr});
}

}  // namespace alpenglow
