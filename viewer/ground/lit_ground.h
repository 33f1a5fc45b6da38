// SPDX-License-Identifier: MIT
// Heights of a mesh that is one surface, quickly: the triangles over each cell of a grid.
//
// Land around the eye and what does not change with the sun: triangles ready for rays, horizons,
// what the slopes see of each other, materials.
//
// Frame: east, north, up of a place near the eye (SceneGround::frame), metres. Altitudes are those
// over the sphere that osculates the ellipsoid there.
//
// Light on the land for one position of the sun, vertex by vertex: what the graphics card
// interpolates over its triangles.
//
// Sky and slopes as TerrainLight has them; the edge of shade by ShadowHeights. Both change slowly
// over the ground but for the edges, which are interpolated as a height over them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/ground/scene_geometry.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/ground/surface.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/light/lighting.h"
#include "renderer/light/terrain_light.h"
#include "renderer/picture/ground_light.h"
#include "renderer/scene/scene.h"
#include "renderer/shadow/shadow_heights.h"
#include "renderer/terrain/mesh.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Immutable; safe to ask from many threads. Refers to the mesh.
class MeshHeights {
 public:
  explicit MeshHeights(const TriangleMesh& mesh);

  /// z [m] of the triangle over a place, to the rounding of its corners; nothing beside the mesh.
  [[nodiscard]] std::optional<double> At(double x_m, double y_m) const;

 private:
  struct Cells {
    std::size_t first_column, last_column, first_row, last_row;
  };
  [[nodiscard]] Cells Under(const std::array<std::uint32_t, 3>& triangle) const;
  template <typename Visit>
  void VisitCells(const Visit& visit) const;

  const TriangleMesh& mesh_;
  double west_m_ = 0.0, south_m_ = 0.0, cell_m_ = 1.0;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> first_;      // of a cell's triangles; one more than cells
  std::vector<std::uint32_t> triangles_;  // cell by cell
};

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

/// What shines on it.
struct LitVertex {
  /// Beyond that many radii it is only the sign that matters; as far as that, heights place the
  /// edges of shade between vertices.
  static constexpr double kMostRadii = 64.0;

  std::array<float, 4> sky;  // irradiance of sky and slopes per unit solar irradiance, by band
  float sun_x;  // height of the disk's centre over the edge of terrain that cuts it [radii of the
                // disk]: see SunlightOverEdge. The planet's own horizon is not among the edges.
};

/// From one local frame to another of the same ellipsoid.
class SiteFromFrame {
 public:
  SiteFromFrame(const LocalFrame& site, const LocalFrame& frame);

  [[nodiscard]] std::array<float, 3> Point(const glm::vec3& point_m) const;
  [[nodiscard]] std::array<float, 3> Along(const glm::vec3& direction) const;

 private:
  glm::dmat3 turn_;
  glm::dvec3 origin_;
};

/// Vertices in another frame of the same ellipsoid, which have position_m and normal, made ready.
template <typename Vertex>
[[nodiscard]] std::vector<GroundVertex> VerticesIn(const GroundSite& site, const LocalFrame& frame,
                                                   std::span<const Vertex> vertices) {
  const SiteFromFrame turned(site.ground().frame, frame);
  std::vector<GroundVertex> ready;
  ready.reserve(vertices.size());
  for (const Vertex& vertex : vertices)
    ready.push_back(site.Vertex(turned.Point(vertex.position_m), turned.Along(vertex.normal)));
  return ready;
}

[[nodiscard]] inline std::array<float, 4> InFourBands(const BandLight& light) {
  std::array<float, 4> four{};
  std::copy_n(light.value.begin(), light.count, four.begin());
  return four;
}

/// The light of the sky that a sun or moon makes over a site, and of its slopes. Immutable; safe to ask
/// from many threads.
class GroundSky {
 public:
  /// Works on the calling thread alone.
  /// @param light  the sun or moon in the frame of the site.
  GroundSky(std::shared_ptr<const GroundSite> site, Lighting light);

  [[nodiscard]] const Lighting& lighting() const { return light_; }
  [[nodiscard]] const GroundSite& site() const { return *site_; }

  [[nodiscard]] TerrainLight::OnSlope On(const GroundVertex& vertex) const;

 private:
  std::shared_ptr<const GroundSite> site_;
  Lighting light_;
};

/// Immutable; safe to ask from many threads.
class LitGround {
 public:
  /// Places of a grid are asked, not rays: of 1024 samples a side 28 MB instead of 61.
  static constexpr ShadowHeights::Options kShadowOfVertices{.fewest_lines = 1.0, .for_rays = false};
  /// Works on the calling thread alone.
  /// @param light  the sun in the frame of the site.
  /// @param shadow  how fine the shadow is: see ShadowHeights. Over the built-in range at cells of
  ///     45 m, two thirds of its spacing, 0.5 to 0.9 % of places between vertices are lit or shaded
  ///     wrongly, at cells of 90 m, prepared in half the time, 0.5 to 1.2 %.
  LitGround(std::shared_ptr<const GroundSite> site, Lighting light,
            const ShadowHeights::Options& shadow = kShadowOfVertices);

  [[nodiscard]] const GroundSky& sky() const { return sky_; }
  [[nodiscard]] const Lighting& lighting() const { return sky_.lighting(); }
  [[nodiscard]] const GroundSite& site() const { return sky_.site(); }

  [[nodiscard]] LitVertex At(const GroundVertex& vertex) const {
    const TerrainLight::OnSlope on = sky_.On(vertex);
    return {InFourBands(on.sky + on.slopes), EdgeOver(vertex)};
  }
  /// LitVertex::sun_x.
  [[nodiscard]] float EdgeOver(const GroundVertex& vertex) const;

  /// Of vertices in another frame of the same ellipsoid, which have position_m and normal.
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

}  // namespace alpenglow::viewer
