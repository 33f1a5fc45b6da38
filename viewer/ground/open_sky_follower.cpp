// SPDX-License-Identifier: MIT
#include "viewer/ground/open_sky_follower.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace alpenglow::viewer {
namespace {

// At dusk the light decreases by 0.2 % while the sun sinks by this angle.
constexpr double kLeft_rad = 3e-5;

int CellOf(double elevation_rad) {
  return static_cast<int>(std::floor(elevation_rad / OpenSkyFollower::kStep_rad));
}

OpenSky AtNode(OpenSky sky, int node) {
  sky.elevation_rad = node * OpenSkyFollower::kStep_rad;
  return sky;
}

// Returns whether two skies differ in the elevation of the light only.
bool IsSamePlace(const OpenSky& one, const OpenSky& other) {
  return one.air == other.air && one.altitude_m == other.altitude_m;
}

float Between(float low, float high, float share) {
  if (low > 0.0F && high > 0.0F) return low * std::pow(high / low, share);
  return std::lerp(low, high, share);
}

SkyIrradianceGradient Between(const SkyIrradianceGradient& low, const SkyIrradianceGradient& high,
                              double share) {
  SkyIrradianceGradient light = low;
  for (std::size_t node = 0; node < light.nodes.size(); ++node)
    for (std::size_t band = 0; band < light.nodes[node].size(); ++band)
      light.nodes[node][band] =
          Between(low.nodes[node][band], high.nodes[node][band], static_cast<float>(share));
  return light;
}

}  // namespace

SkyIrradianceGradient OpenSkyFollower::LightOf(const OpenSky& sky) {
  return {sky.air->single_scattering(), sky.air->multiple_scattering(), sky.altitude_m,
          std::sin(sky.elevation_rad)};
}

// The thread of this object uses one processor, so that drawing keeps the others.
OpenSkyFollower::OpenSkyFollower(Make make)
    : make_(std::move(make)),
      maker_(
          [this](const OpenSky& sky) {
            tbb::task_arena alone(1);
            return alone.execute([&] { return Made{sky, make_(sky)}; });
          },
          std::equal_to<OpenSky>()) {}

const SkyIrradianceGradient* OpenSkyFollower::TableOf(const OpenSky& sky) const {
  const auto found = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const Made& made) { return made.sky == sky; });
  return found != tables_.end() ? &found->light : nullptr;
}

void OpenSkyFollower::TakeOver(const OpenSky& sky) {
  constexpr std::size_t kMost = 4;  // around the light, and one ahead
  std::optional<Made> made = maker_.Poll();
  if (!made || !IsSamePlace(made->sky, sky)) return;
  if (!tables_.empty() && !IsSamePlace(tables_.front().sky, sky)) tables_.clear();
  const auto farther = [&](const Made& one, const Made& other) {
    return std::abs(one.sky.elevation_rad - sky.elevation_rad) <
           std::abs(other.sky.elevation_rad - sky.elevation_rad);
  };
  if (tables_.size() == kMost)
    tables_.erase(std::max_element(tables_.begin(), tables_.end(), farther));
  tables_.push_back(std::move(*made));
}

void OpenSkyFollower::RequestMissing(const OpenSky& sky, int below) {
  if (shown_ && sky.elevation_rad != shown_->elevation_rad)
    sinks_ = sky.elevation_rad < shown_->elevation_rad;
  for (const int node : {below, below + 1, sinks_ ? below - 1 : below + 2})
    if (TableOf(AtNode(sky, node)) == nullptr) return maker_.RequestWhenIdle(AtNode(sky, node));
}

void OpenSkyFollower::FollowExactly(const OpenSky& sky) {
  if (is_exact_ && shown_ && IsSamePlace(*shown_, sky) &&
      std::abs(shown_->elevation_rad - sky.elevation_rad) <= kLeft_rad)
    return;
  WaitUntilReady(sky);
}

void OpenSkyFollower::Follow(const OpenSky& sky) {
  TakeOver(sky);
  const int below = CellOf(sky.elevation_rad);
  RequestMissing(sky, below);
  const SkyIrradianceGradient* const low = TableOf(AtNode(sky, below));
  const SkyIrradianceGradient* const high = TableOf(AtNode(sky, below + 1));
  if (low == nullptr || high == nullptr) return FollowExactly(sky);
  light_ = Between(*low, *high, sky.elevation_rad / kStep_rad - below);
  shown_ = sky;
  is_exact_ = false;
}

void OpenSkyFollower::WaitUntilReady(const OpenSky& sky) {
  light_ = make_(sky);
  shown_ = sky;
  is_exact_ = true;
}

}  // namespace alpenglow::viewer
