// SPDX-License-Identifier: MIT
#include "viewer/lamps/fog_follower.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow::viewer {

bool Serves(const FogMap& map, const FogView& view) {
  constexpr double kSun_rad = 0.1 * 3.14159265358979 / 180.0;
  const double step_m = 0.1 * std::min(map.scale_height_m, 1000.0);
  return std::abs(map.view.altitude_m - view.altitude_m) <= step_m &&
         glm::length(map.view.to_sun - view.to_sun) <= kSun_rad;
}

bool FogFollower::Follow(const FogView& view) {
  std::optional<FogMap> made = job_.Take();
  const bool is_new = made.has_value();
  if (is_new) map_ = std::move(made);
  if (!(map_ && Serves(*map_, view)) && !job_.Busy()) job_.Ask(view);
  return is_new;
}

void FogFollower::Wait(const FogView& view) {
  if (map_ && Serves(*map_, view)) return;
  job_.Ask(view);
  job_.Wait();
  if (std::optional<FogMap> made = job_.Take()) map_ = std::move(made);
}

}  // namespace alpenglow::viewer
