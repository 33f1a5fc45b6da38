// SPDX-License-Identifier: MIT
#include "renderer/picture/recent_sunlight.h"

#include <utility>

#include "renderer/effect/effect_choice.h"

namespace alpenglow::renderer {

RecentSunlight::Made RecentSunlight::At(const glm::dvec3& to_sun, double sun_radius_rad) {
  constexpr std::size_t kMost = 2;
  const std::lock_guard lock(asking_);
  for (const Kept& kept : kept_) {
    if (kept.to_sun == to_sun && kept.sun_radius_rad == sun_radius_rad) return kept.made;
  }
  if (kept_.size() == kMost) kept_.pop_front();
  const Stopwatch watch;
  auto sunlight = std::make_shared<const TerrainSunlight>(ground_, to_sun, sun_radius_rad);
  kept_.push_back({to_sun, sun_radius_rad, {std::move(sunlight), watch.seconds()}});
  return kept_.back().made;
}

}  // namespace alpenglow::renderer
