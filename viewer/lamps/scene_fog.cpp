// SPDX-License-Identifier: MIT
#include "viewer/lamps/scene_fog.h"

#include <tbb/task_arena.h>

#include <utility>

namespace alpenglow::viewer {
namespace {

FogView FogViewOf(const Eye& eye, const SunPosition& sun) {
  const auto towards = [](const SunPosition& at) {
    return DirectionFromAngles(at.elevation_rad, at.azimuth_rad).xyz;
  };
  return {eye.place.height_m, towards(sun), towards(SunForAir(sun)), sun.angular_radius_rad};
}

}  // namespace

SceneFog::SceneFog(LocalMedia media, const FogMapSize& size, const FogUnits& units)
    : media_(std::make_shared<const LocalMedia>(std::move(media))), size_(size), painter_(units) {}

void SceneFog::SetSize(const FogMapSize& size) {
  if (size == size_) return;
  size_ = size;
  air_ = nullptr;
}

// On one thread, so that drawing keeps the others.
void SceneFog::BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad) {
  air_ = air;
  follower_.emplace([air, media = media_, size = size_, latitude_rad](const FogView& wanted) {
    tbb::task_arena alone(1);
    return alone.execute([&] {
      const AirIntegrator<float> integrator(OnOsculatingSphere(air->medium, latitude_rad));
      return MakeFogMap(*media->fog(), media->fog_bottom_m(), {integrator, air->beam, air->diffuse},
                        wanted, size);
    });
  });
}

void SceneFog::Follow(const std::shared_ptr<const SolvedAir>& air, const Eye& eye,
                      const SunPosition& sun) {
  if (air_ != air) return Settle(air, eye, sun);
  if (follower_->Follow(FogViewOf(eye, sun))) painter_.Upload(*follower_->map());
}

void SceneFog::Settle(const std::shared_ptr<const SolvedAir>& air, const Eye& eye,
                      const SunPosition& sun) {
  if (air_ != air) BeginIn(air, eye.place.latitude_rad);
  follower_->Wait(FogViewOf(eye, sun));
  painter_.Upload(*follower_->map());
}

double SceneFog::ExtinctionAt(double altitude_m) const {
  const LocalMedium& fog = *media_->fog();
  return fog.optics.extinction_per_m[0] * fog.fog()->DensityAtAltitude(altitude_m);
}

void SceneFog::Bind(const Eye& eye, const SunPosition& sun) const {
  painter_.Bind(*follower_->map(), FogViewOf(eye, sun));
}

}  // namespace alpenglow::viewer
