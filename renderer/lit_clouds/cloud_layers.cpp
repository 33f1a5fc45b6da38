// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_layers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/math/constants.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/cloud_phase/ice_phase.h"

namespace alpenglow::renderer {
namespace {

/// The wavelength of the phase functions. The index of water hardly depends on it.
constexpr double kPhase_nm = 550.0;
/// Sun and moon of two frames.
constexpr std::size_t kKept = 4;

/// Returns the direction of the beam in a field: that of the light. No cloud sees a light below the
/// lowest one; one in the zenith is solved fastest.
glm::dvec3 BeamDirection(const glm::dvec3& to_light) {
  const bool is_seen = to_light.z >= std::sin(kLowestCloudLight_deg * kPi / 180.0);
  return is_seen ? to_light : glm::dvec3(0.0, 0.0, 1.0);
}

CloudLightOptions LightOptions(double planet_radius_m) {
  CloudLightOptions options;
  options.low_sun.planet_radius_m = planet_radius_m;
  options.low_sun.farthest_m = kFarthestCloudShade_m;
  options.low_sun.full_m = kFullCloudShade_m;
  return options;
}

}  // namespace

CloudPhases PhasesOf(const SceneCloudField& layer) {
  return layer.is_of_ice ? IcePhases(kPhase_nm) : DropletPhases(kPhase_nm);
}

bool CloudsByTime::HasAny() const { return !scene_.clouds.empty(); }

SolvedClouds CloudsByTime::Solved(double time_s, const glm::dvec3& to_light) const {
  const glm::dvec3 beam = BeamDirection(to_light);
  const auto same_time = std::find_if(made_.begin(), made_.end(),
                                      [&](const Made& made) { return made.time_s == time_s; });
  SolvedClouds solved;
  if (same_time != made_.end()) {
    solved.layers = same_time->clouds->layers;
    for (const CloudLight& light : same_time->clouds->light)
      solved.light.push_back(light.WithSun(beam));
    return solved;
  }
  solved.layers = std::make_shared<const CloudLayers>(CloudFieldsOf(scene_, time_s));
  for (const SceneCloudField& layer : *solved.layers) {
    solved.light.emplace_back(
        layer.field, CloudScatterers{PhasesOf(layer)},
        CloudSurroundings{.to_sun = beam,
                          .ground_altitude_m = std::min(ground_m_, layer.field.base_altitude_m())},
        LightOptions(radius_m_));
  }
  return solved;
}

std::shared_ptr<const SolvedClouds> CloudsByTime::At(const UtcTime& time,
                                                     const glm::dvec3& to_light) {
  const double time_s = CloudTime_s(scene_, time);
  const std::lock_guard lock(asking_);
  for (const Made& made : made_) {
    if (made.time_s == time_s && made.to_light == to_light) return made.clouds;
  }
  auto clouds = std::make_shared<const SolvedClouds>(Solved(time_s, to_light));
  if (made_.size() == kKept) made_.pop_front();
  made_.push_back({time_s, to_light, std::move(clouds)});
  return made_.back().clouds;
}

}  // namespace alpenglow::renderer
