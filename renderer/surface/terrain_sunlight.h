// SPDX-License-Identifier: MIT
// TerrainSunlight finds sunlight in air and clouds over the terrain, by the method that suits the
// terrain.
#pragma once

#include <glm/vec3.hpp>
#include <variant>

#include "renderer/surface/scene_ground.h"
#include "renderer/visibility/shadow_heights.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

/// Sunlight over terrain for one position of the sun. It uses ShadowHeights over ground that is one
/// surface, and SunProbes over meshes with overhangs. The light is unbroken without terrain, and
/// when the sun is so low that beams which pass the planet's horizon are high above the terrain.
class TerrainSunlight {
 public:
  /// Creates unbroken light.
  TerrainSunlight() = default;
  /// Refers to the ground.
  TerrainSunlight(const SceneGround& ground, const glm::dvec3& to_light, double radius_rad);

  /// Returns whether terrain can cast shadows.
  [[nodiscard]] bool IsBroken() const;
  /// Returns the stretches of a ray within [0, length_m] that terrain does not shade from the sun;
  /// length_m is finite. The planet's own shadow is not considered.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;
  /// Returns the sunlight that terrain lets through to a point of the air, in [0, 1].
  [[nodiscard]] double At(const glm::dvec3& point) const;

 private:
  struct Unbroken {};
  std::variant<Unbroken, ShadowHeights, SunProbes> method_;
};

}  // namespace alpenglow::renderer
