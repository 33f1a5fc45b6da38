// SPDX-License-Identifier: MIT
// Ground whose shade can be told by hand.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "renderer/layer.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Level ground with a ridge 60 m high that runs east, 150 m north of the origin.
inline SceneGround Ridge(const Scene& scene) {
  constexpr int kSide = 121;
  constexpr float kStep_m = 10.0F;
  TriangleMesh mesh;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const float x = kStep_m * static_cast<float>(i - kSide / 2);
      const float y = kStep_m * static_cast<float>(j - kSide / 2);
      mesh.positions.push_back({x, y, std::max(60.0F - 2.0F * std::abs(y - 150.0F), 0.0F)});
      mesh.normals.push_back({0.0F, 0.0F, 1.0F});
      if (i == 0 || j == 0) continue;
      const auto here = static_cast<std::uint32_t>(j * kSide + i);
      mesh.triangles.push_back({here - kSide - 1, here - kSide, here});
      mesh.triangles.push_back({here - kSide - 1, here, here - 1});
    }
  }
  SceneGround ground = LoadGround(scene);
  ground.terrain.emplace(std::move(mesh));
  ground.is_one_surface = true;
  return ground;
}

}  // namespace alpenglow::renderer
