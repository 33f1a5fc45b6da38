// SPDX-License-Identifier: MIT
#include "renderer/surface/terrain_sunlight.h"

#include <cmath>

#include "atmosphere/math/constants.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

TerrainSunlight::TerrainSunlight(const SceneGround& ground, const glm::dvec3& to_light,
                                 double radius_rad) {
  // At -3 degrees a beam has touched the planet 330 km away, and passes 4 km above ground that is
  // 100 km nearer to the sun than the place it lights.
  constexpr double kLowestSun_rad = -3.0 * kRadiansPerDegree;
  if (!ground.terrain || std::asin(to_light.z) < kLowestSun_rad) return;
  if (ground.is_one_surface) {
    method_.emplace<ShadowHeights>(ground.terrain->mesh(), to_light, radius_rad);
  } else {
    method_.emplace<SunProbes>(*ground.terrain, to_light, radius_rad);
  }
}

bool TerrainSunlight::IsBroken() const { return !std::holds_alternative<Unbroken>(method_); }

double TerrainSunlight::At(const glm::dvec3& point) const {
  if (const auto* heights = std::get_if<ShadowHeights>(&method_)) return heights->SunlightAt(point);
  if (const auto* probes = std::get_if<SunProbes>(&method_)) return probes->SunlightAt(point);
  return 1.0;
}

SunlitPath TerrainSunlight::Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                  double length_m) const {
  if (const auto* heights = std::get_if<ShadowHeights>(&method_))
    return heights->Along(origin, unit, length_m);
  if (const auto* probes = std::get_if<SunProbes>(&method_))
    return probes->Along(origin, unit, length_m);
  return length_m > 0.0 ? SunlitPath{{0.0, length_m}} : SunlitPath{};
}

}  // namespace alpenglow::renderer
