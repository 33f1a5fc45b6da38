// SPDX-License-Identifier: MIT
// Sunlight in the air over the terrain of a scene, by the method that fits the terrain.
#pragma once

#include <glm/vec3.hpp>
#include <variant>

#include "renderer/ground/scene_ground.h"
#include "renderer/shadow/shadow_heights.h"
#include "renderer/shadow/sun_probes.h"

namespace alpenglow::renderer {

/// For one position of the sun. ShadowHeights over ground that is one surface, SunProbes over
/// meshes with overhangs; unbroken light without terrain, and with the sun so low that the beams
/// over the terrain have passed over the planet's horizon high above it.
class TerrainSunlight {
 public:
  /// Unbroken light.
  TerrainSunlight() = default;
  /// Refers to the ground.
  TerrainSunlight(const SceneGround& ground, const glm::dvec3& to_sun, double sun_radius_rad);

  /// Whether terrain can shade anything.
  [[nodiscard]] bool IsBroken() const;
  /// The stretches of a ray within [0, length_m] that the sun reaches; length_m is finite. The
  /// shadow of the planet itself is not among them.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

 private:
  struct Unbroken {};
  std::variant<Unbroken, ShadowHeights, SunProbes> method_;
};

}  // namespace alpenglow::renderer
