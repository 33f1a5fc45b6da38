// SPDX-License-Identifier: MIT
#include "viewer/lamps/fog_follower.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/number/constants.h"

namespace alpenglow {
namespace {

bool Suits(const FogView& made, const FogView& now) {
  constexpr double kTurned = 0.05 * kRadiansPerDegree;
  return glm::length(made.to_sun - now.to_sun) < kTurned &&
         std::abs(made.altitude_m - now.altitude_m) < std::max(2.0, 0.02 * now.altitude_m);
}

}  // namespace

FogFollower::FogFollower(LocalMedia media, const FogUnits& units)
    : painter_(units), maker_([media = std::move(media)](const Request& request) {
        tbb::task_arena alone(1);
        return alone.execute([&] {
          const AirIntegrator<float> air(
              OnOsculatingSphere(request.air->medium, request.latitude_rad));
          return MakeFogMap(*media.fog(), media.fog_bottom_m(), air, request.air->diffuse,
                            request.view);
        });
      }) {}

void FogFollower::Take() {
  std::optional<FogMap> made = maker_.Take();
  if (!made) return;
  map_ = std::move(made);
  painter_.Upload(*map_);
}

void FogFollower::Follow(const std::shared_ptr<const SolvedAir>& air, double latitude_rad,
                         const FogView& view) {
  if (!map_) return Settle(air, latitude_rad, view);
  Take();
  if (maker_.Busy() || (asked_->air == air && Suits(asked_->view, view))) return;
  asked_ = Request{air, latitude_rad, view};
  maker_.Ask(*asked_);
}

void FogFollower::Settle(const std::shared_ptr<const SolvedAir>& air, double latitude_rad,
                         const FogView& view) {
  asked_ = Request{air, latitude_rad, view};
  maker_.Ask(*asked_);
  maker_.Wait();
  Take();
}

}  // namespace alpenglow
