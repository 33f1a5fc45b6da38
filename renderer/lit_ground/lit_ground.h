// SPDX-License-Identifier: MIT
// Provides the light on the land for one position of the sun, vertex by vertex; the GPU
// interpolates it over triangles. The parts are
//   GroundSite   land around the eye with everything that does not depend on the sun: triangles
//                ready for rays, horizons, the mutual visibility of slopes, materials,
//   GroundSky    light of sky and slopes, by TerrainIrradiance,
//   LitGround    the above with the edges of shadows, by ShadowHeights.
//
// Frame: east, north, up of a place near the eye (SceneGround::frame), metres. Altitudes are above
// the sphere that osculates the ellipsoid there.
//
// Light of sky and slopes and the edges of shadows vary slowly over the ground, except across the
// edges. An edge is therefore interpolated as a height of the sun over it.
#pragma once

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/elevation/mesh.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/terrain_irradiance.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/layer.h"
#include "renderer/lit_ground/ground_light.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"
#include "renderer/visibility/shadow_heights.h"

namespace alpenglow::renderer {

/// Returns the ground of an elevation model around a place, without objects on it. Works on the
/// calling thread alone.
[[nodiscard]] SceneGround GroundOf(const ElevationGrid& grid, const LocalFrame& frame);

/// A vertex of the land in the frame of its site.
struct GroundVertex {
  std::array<float, 3> position_m;
  std::array<float, 3> normal;  // unit normal of the mesh, without finer relief
  float site_z_m;               // height of the site's ground at this place
};

/// Land around the eye. It is immutable and can be used by many threads.
class GroundSite {
 public:
  /// Works on the calling thread alone: a second for a thousand samples per side.
  /// @param ground  ground with terrain that is one surface.
  /// @param cover  material of the ground; drape: colours over it, or null.
  /// @param air  on the sphere of the site.
  GroundSite(SceneGround ground, const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
             SolvedAir air);
  GroundSite(const GroundSite&) = delete;
  GroundSite& operator=(const GroundSite&) = delete;

  [[nodiscard]] const SceneGround& ground() const { return ground_; }
  [[nodiscard]] const SceneGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const Medium& medium() const { return air_.medium(); }

  [[nodiscard]] const GroundMaterial& material() const { return material_; }
  [[nodiscard]] const SolvedAir& air() const { return air_; }
  [[nodiscard]] const GroundLight& light() const { return light_; }

  /// Returns the horizons; null if the ground is not one surface.
  [[nodiscard]] std::shared_ptr<const TerrainHorizons> horizons() const { return horizons_.Get(); }

  /// Prepares a vertex for the light of any sun. Meshes of other detail than the site's lie partly
  /// above and partly below it. Their shadows are therefore looked up at the height of the site's
  /// ground.
  [[nodiscard]] GroundVertex Vertex(const std::array<float, 3>& position_m,
                                    const std::array<float, 3>& normal) const;

  /// Returns the light of sky and sun on the terrain: see GroundLight::OnTerrain.
  [[nodiscard]] std::shared_ptr<const TerrainIrradiance> Under(const Lighting& light) const;

 private:
  SolvedAir air_;
  SceneGround ground_;
  SceneGeometry geometry_;
  GroundMaterial material_;
  LampLight no_lamps_;
  HorizonsOnDemand horizons_;
  MeshHeights heights_;
  GroundLight light_;  // refers to all members above
};

/// Light on a vertex.
struct LitVertex {
  /// Beyond this many radii only the sign of sun_x matters. Below it, sun_x locates the edges of
  /// shadows between vertices.
  static constexpr double kMostRadii = 64.0;

  std::array<float, 4> sky;  // irradiance of sky and slopes per unit solar irradiance, by band
  float sun_x;  // height of the centre of the disk above the edge of terrain that cuts it [radii of
                // the disk]: see SunlightOverEdge. The horizon of the planet is not one of these
                // edges.
};

/// Prepares vertices of another frame of the same ellipsoid. They have position_m and normal.
template <typename Vertex>
[[nodiscard]] std::vector<GroundVertex> VerticesIn(const GroundSite& site, const LocalFrame& frame,
                                                   std::span<const Vertex> vertices) {
  const FrameTransform to_site(site.ground().frame, frame);
  const auto floats = [](const glm::dvec3& v) {
    return std::array<float, 3>{static_cast<float>(v.x), static_cast<float>(v.y),
                                static_cast<float>(v.z)};
  };
  std::vector<GroundVertex> ready;
  ready.reserve(vertices.size());
  for (const Vertex& vertex : vertices)
    ready.push_back(site.Vertex(floats(to_site.Point(glm::dvec3(vertex.position_m))),
                                floats(to_site.Along(glm::dvec3(vertex.normal)))));
  return ready;
}

[[nodiscard]] inline std::array<float, 4> InFourBands(const Spectrum& light) {
  std::array<float, 4> four{};
  std::ranges::copy(light.values(), four.begin());
  return four;
}

/// Light of sky and slopes over a site for one sun or moon. It is immutable and can be used by many
/// threads.
class GroundSky {
 public:
  /// Works on the calling thread alone.
  /// @param light  the sun or moon in the frame of the site.
  GroundSky(std::shared_ptr<const GroundSite> site, Lighting light);

  [[nodiscard]] const Lighting& lighting() const { return light_; }
  [[nodiscard]] const GroundSite& site() const { return *site_; }

  [[nodiscard]] TerrainIrradiance::OnSlope On(const GroundVertex& vertex) const;

 private:
  std::shared_ptr<const GroundSite> site_;
  Lighting light_;
};

/// Light on the land for one position of the sun. It is immutable and can be used by many threads.
class LitGround {
 public:
  /// Options for look-ups at places of a grid instead of along rays: for 1024 samples per side they
  /// take 28 MB instead of 61.
  static constexpr ShadowHeights::Options kShadowOfVertices{.fewest_lines = 1.0, .for_rays = false};
  /// Works on the calling thread alone.
  /// @param light  the sun in the frame of the site.
  /// @param shadow  resolution of the shadow: see ShadowHeights. Over the built-in range with cells
  ///     of 45 m, two thirds of its spacing, 0.5 to 0.9 % of places between vertices are wrongly
  ///     lit or shadowed. With cells of 90 m it is 0.5 to 1.2 %, and the preparation takes half the
  ///     time.
  LitGround(std::shared_ptr<const GroundSite> site, Lighting light,
            const ShadowHeights::Options& shadow = kShadowOfVertices);

  [[nodiscard]] const GroundSky& sky() const { return sky_; }
  [[nodiscard]] const Lighting& lighting() const { return sky_.lighting(); }
  [[nodiscard]] const GroundSite& site() const { return sky_.site(); }

  [[nodiscard]] LitVertex At(const GroundVertex& vertex) const {
    const TerrainIrradiance::OnSlope on = sky_.On(vertex);
    return {InFourBands(on.sky + on.slopes), EdgeOver(vertex)};
  }
  /// Returns LitVertex::sun_x.
  [[nodiscard]] float EdgeOver(const GroundVertex& vertex) const;

  /// Returns the light of vertices of another frame of the same ellipsoid. They have position_m and
  /// normal.
  template <typename Vertex>
  [[nodiscard]] std::vector<LitVertex> LightIn(const LocalFrame& frame,
                                               std::span<const Vertex> vertices) const {
    const std::vector<GroundVertex> ready = VerticesIn(site(), frame, vertices);
    std::vector<LitVertex> lit;
    lit.reserve(ready.size());
    for (const GroundVertex& vertex : ready) lit.push_back(At(vertex));
    return lit;
  }

 private:
  GroundSky sky_;
  ShadowHeights shadow_;
};

}  // namespace alpenglow::renderer
