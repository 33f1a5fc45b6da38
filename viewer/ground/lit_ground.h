// SPDX-License-Identifier: MIT
// Light on the land for one position of the sun, vertex by vertex: what the graphics card
// interpolates over its triangles.
//
// Sky and slopes as TerrainLight has them; the edge of shade by ShadowHeights. Both change slowly
// over the ground but for the edges, which are interpolated as a height over them.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "renderer/light/lighting.h"
#include "renderer/shadow/shadow_heights.h"
#include "viewer/ground/ground_site.h"
#include "viewer/ground/sky_tilt.h"
#include "viewer/land/land_chunk.h"

namespace alpenglow {

/// Immutable; safe to ask from many threads.
class LitGround {
 public:
  /// VertexLight::sun_x is clamped to so many radii either way: beyond, it is only the sign that
  /// matters; as far as that, heights place the edges of shade between vertices. The planet's own
  /// horizon is not among the edges.
  static constexpr double kMostRadii = 64.0;

  /// Works on the calling thread alone.
  /// @param light  the sun in the frame of the site.
  /// @param shadow  how fine the shadow is: see ShadowHeights. Over the built-in range at its own
  ///     cells of 45 m 0.5 to 0.9 % of places between vertices are lit or shaded wrongly, at cells
  ///     of 90 m, prepared in half the time, 0.5 to 1.2 %.
  LitGround(std::shared_ptr<const GroundSite> site, Lighting light,
            const ShadowHeights::Options& shadow = ShadowHeights::Options{});

  [[nodiscard]] const Lighting& lighting() const { return light_; }
  [[nodiscard]] const SkyTilt& tilt() const { return tilt_; }
  [[nodiscard]] const GroundSite& site() const { return *site_; }

  [[nodiscard]] VertexLight At(const GroundVertex& vertex) const;
  [[nodiscard]] std::vector<VertexLight> LightOf(std::span<const GroundVertex> vertices) const;

 private:
  std::shared_ptr<const GroundSite> site_;
  Lighting light_;
  ShadowHeights shadow_;
  SkyTilt tilt_;
};

}  // namespace alpenglow
