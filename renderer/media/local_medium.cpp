// SPDX-License-Identifier: MIT
#include "renderer/media/local_medium.h"

namespace alpenglow::renderer {

std::optional<double> TerrainTop(const SceneGround& ground, double x, double y) {
  constexpr double kAbove_m = 20000.0;
  if (!ground.terrain) return std::nullopt;
  const auto hit = ground.terrain->Intersect({x, y, kAbove_m}, {0.0, 0.0, -1.0});
  if (!hit) return std::nullopt;
  return kAbove_m - hit->distance_m;
}

}  // namespace alpenglow::renderer
