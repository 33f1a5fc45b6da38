// SPDX-License-Identifier: MIT
// Land around the eye and what does not change with the sun: triangles ready for rays, horizons,
// what the slopes see of each other, materials.
//
// Frame: east, north, up of a place near the eye (SceneGround::frame), metres. Altitudes are those
// over the sphere that osculates the ellipsoid there.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>

#include "renderer/ground/ground_material.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/light/terrain_light.h"
#include "renderer/picture/ground_light.h"
#include "renderer/scene/scene.h"
#include "viewer/ground/mesh_heights.h"

namespace alpenglow::viewer {

/// The air over the land: all of one medium on the sphere of the site.
struct SiteAir {
  std::shared_ptr<const AirIntegrator<float>> integrator;
  std::shared_ptr<const BentBeam> beam;
  std::shared_ptr<const DiffuseLight> diffuse;
};

/// The ground that an elevation model makes around a place; nothing stands on it. Works on the
/// calling thread alone.
[[nodiscard]] SceneGround GroundOf(const ElevationGrid& grid, const LocalFrame& frame);

/// A vertex of the land in the frame of its site.
struct GroundVertex {
  std::array<float, 3> position_m;
  std::array<float, 3> normal;  // unit, of the mesh: without finer relief
  float site_z_m;               // of the site's ground there
};

[[nodiscard]] inline glm::dvec3 InDoubles(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Immutable; safe to ask from many threads.
class GroundSite {
 public:
  /// Works on the calling thread alone: a second for a thousand samples a side.
  /// @param ground  with terrain, in one surface.
  /// @param cover  what it is made of; drape: colours over it, or null.
  GroundSite(SceneGround ground, const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
             SiteAir air);
  GroundSite(const GroundSite&) = delete;
  GroundSite& operator=(const GroundSite&) = delete;

  [[nodiscard]] const SceneGround& ground() const { return ground_; }
  [[nodiscard]] const SceneGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const Medium& medium() const { return air_.integrator->medium(); }

  [[nodiscard]] const GroundMaterial& material() const { return material_; }
  [[nodiscard]] const SiteAir& air() const { return air_; }
  [[nodiscard]] const GroundLight& light() const { return light_; }

  /// Null: the ground is not one surface.
  [[nodiscard]] std::shared_ptr<const TerrainHorizons> horizons() const { return horizons_.Get(); }

  /// A vertex made ready for light of any sun. Meshes of another detail than the site's lie over
  /// and under it; so that its shadow neither covers nor misses them, they have that of its ground.
  [[nodiscard]] GroundVertex Vertex(const std::array<float, 3>& position_m,
                                    const std::array<float, 3>& normal) const;

  /// What terrain makes of the light of sky and sun: see GroundLight::OnTerrain.
  [[nodiscard]] std::shared_ptr<const TerrainLight> Under(const Lighting& light) const;

 private:
  SiteAir air_;
  SceneGround ground_;
  SceneGeometry geometry_;
  GroundMaterial material_;
  LampLight no_lamps_;
  HorizonsOnDemand horizons_;
  MeshHeights heights_;
  GroundLight light_;  // refers to all above
};

}  // namespace alpenglow::viewer
