// SPDX-License-Identifier: MIT
// Light on the land for one position of the sun, vertex by vertex: what the graphics card
// interpolates over its triangles.
//
// Sky and slopes as TerrainLight has them; the edge of shade by ShadowHeights. Both change slowly
// over the ground but for the edges, which are interpolated as a height over them.
#pragma once

#include <algorithm>
#include <array>
#include <glm/mat3x3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "renderer/light/lighting.h"
#include "renderer/shadow/shadow_heights.h"
#include "viewer/ground/ground_site.h"

namespace alpenglow::viewer {

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
