// SPDX-License-Identifier: MIT
// The horizon of terrain towards the sun of this moment, on the graphics card: where the sun has moved
// on and the edges of shade that vertices have are those before another sun, the vertices take theirs
// from it. It is coarser (HorizonMap: a node every few hundred metres, sixteen azimuths).
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/shadow/horizon_map.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Horizons around places of a frame.
struct TerrainHorizon {
  std::shared_ptr<const HorizonMap> map;
  LocalFrame frame;
};

/// Where a place of a frame lies in a texture whose texels are the nodes of a grid: u and v are the products
/// of these rows and (x, y, z, 1) [m].
struct PlaceOnGrid {
  glm::vec4 u{0.0F}, v{0.0F};
};
/// @param grid  in the first frame; places are those of the second.
[[nodiscard]] PlaceOnGrid PlaceOnGridOf(const HeightRaster& grid, const LocalFrame& of_grid,
                                        const LocalFrame& of_places);

class HorizonTexture {
 public:
  void Use(const TerrainHorizon& horizon);
  [[nodiscard]] bool HasAny() const { return horizon_.has_value(); }

  /// Where a place of an anchor's frame lies in the texture.
  [[nodiscard]] PlaceOnGrid PlaceIn(const LocalFrame& anchor) const;

  /// Binds the sines of the horizon towards a direction to a texture unit.
  void Bind(int unit, const Vector<Ecef>& to_sun);

 private:
  void Upload(double azimuth_rad);

  std::optional<TerrainHorizon> horizon_;
  std::optional<double> azimuth_rad_;  // that the texture has
  GlTexture texture_;
};

}  // namespace alpenglow::viewer
