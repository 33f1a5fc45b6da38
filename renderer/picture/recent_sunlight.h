// SPDX-License-Identifier: MIT
// Light of sun or moon in the air over one ground, made once for all pictures of one moment.
#pragma once

#include <deque>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>

#include "renderer/ground/scene_ground.h"
#include "renderer/ground/terrain_sunlight.h"

namespace alpenglow::renderer {

/// Keeps the last two that it has made: a frame of a series is metered small while the frame before
/// it is developed, and drawn then. Safe to ask from many threads.
class RecentSunlight {
 public:
  struct Made {
    std::shared_ptr<const TerrainSunlight> sunlight;
    double made_in_s;  // of all threads together
  };

  /// Refers to the ground.
  explicit RecentSunlight(const SceneGround& ground) : ground_(ground) {}
  /// @param to_sun  as TerrainSunlight takes it.
  [[nodiscard]] Made At(const glm::dvec3& to_sun, double sun_radius_rad);

 private:
  struct Kept {
    glm::dvec3 to_sun;
    double sun_radius_rad;
    Made made;
  };

  const SceneGround& ground_;
  std::mutex asking_;
  std::deque<Kept> kept_;  // the oldest first
};

}  // namespace alpenglow::renderer
