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

/// The wavelength of the phase functions with which light is solved.
constexpr double kPhase_nm = 550.0;
/// Sun and moon of two frames.
constexpr std::size_t kKept = 4;

/// Refraction of a beam that grazes the planet, before and after it does, and the radius of the sun.
constexpr double kMostRefracted_deg = 1.5;

}  // namespace

CloudLowSunOptions LowSunOver(const CloudField& field, double planet_radius_m) {
  constexpr double kFull_m = 60e3, kFading_m = 120e3, kMostFull_m = 280e3;
  const double to_top_m =
      field.top_altitude_m() / std::tan(kLowestCloudSun_deg * kRadiansPerDegree);
  CloudLowSunOptions options{.planet_radius_m = planet_radius_m};
  options.full_m = std::clamp(to_top_m, kFull_m, kMostFull_m);
  options.farthest_m = options.full_m + kFading_m;
  return options;
}

CloudPhases PhasesOf(const SceneCloudField& layer) {
  return PhasesByBand(layer, {kPhase_nm}).front();
}

std::vector<CloudPhases> PhasesByBand(const SceneCloudField& layer,
                                      const std::vector<double>& wavelengths_nm) {
  std::vector<CloudPhases> phases;
  for (const double wavelength_nm : wavelengths_nm) {
    const double within_nm = std::clamp(wavelength_nm, 300.0, 1000.0);
    phases.push_back(layer.is_of_ice ? IcePhases(within_nm) : DropletPhases(within_nm));
  }
  return phases;
}

bool CloudsByTime::HasAny() const { return !scene_.clouds.empty(); }

std::optional<glm::dvec3> CloudsByTime::BeamIn(const CloudField& field, const Light& light) const {
  if (light.to_light.z >= std::sin(kLowestCloudLight_deg * kRadiansPerDegree))
    return light.to_light;
  const auto dip = [&](double altitude_m) {
    return std::acos(radius_m_ / (radius_m_ + std::max(altitude_m, 0.0)));
  };
  // A cloud at the horizon of the eye is as far away as both dips, and its own horizon once more.
  const double lowest_rad = dip(light.eye_altitude_m) + 2.0 * dip(field.top_altitude_m()) +
                            kMostRefracted_deg * kRadiansPerDegree;
  const double depression_rad = std::asin(std::min(-light.to_light.z, 1.0));
  // One in the zenith is solved fastest.
  return depression_rad < lowest_rad ? std::optional(glm::dvec3(0.0, 0.0, 1.0)) : std::nullopt;
}

SolvedClouds CloudsByTime::Solved(double time_s, const Light& light) const {
  const auto same_time = std::find_if(made_.begin(), made_.end(),
                                      [&](const Made& made) { return made.time_s == time_s; });
  SolvedClouds solved;
  if (same_time != made_.end()) {
    solved.layers = same_time->clouds->layers;
    for (const CloudLight& same : same_time->clouds->light)
      solved.light.push_back(same.WithSun(BeamIn(same.field(), light)));
    return solved;
  }
  solved.layers = std::make_shared<const CloudLayers>(CloudFieldsOf(scene_, time_s));
  for (const SceneCloudField& layer : *solved.layers) {
    const auto beam = BeamIn(layer.field, light);
    const CloudSurroundings surroundings{
        .to_sun = beam.value_or(glm::dvec3(0.0, 0.0, 1.0)),
        .ground_altitude_m = std::min(ground_m_, layer.field.base_altitude_m())};
    const CloudScatterers scatterers{PhasesOf(layer)};
    const CloudLightOptions options{.low_sun = LowSunOver(layer.field, radius_m_)};
    solved.light.push_back(beam
                               ? CloudLight(layer.field, scatterers, surroundings, options)
                               : CloudLight::Unlit(layer.field, scatterers, surroundings, options));
  }
  return solved;
}

bool CloudsByTime::IsSolvedFor(const Made& made, double time_s, const Light& light) const {
  return made.time_s == time_s && made.to_light == light.to_light &&
         std::ranges::all_of(made.clouds->light, [&](const CloudLight& of_layer) {
           return of_layer.sun().IsUnlit() == !BeamIn(of_layer.field(), light);
         });
}

std::shared_ptr<const SolvedClouds> CloudsByTime::At(const UtcTime& time, const Light& light) {
  const double time_s = CloudTime_s(scene_, time);
  const std::lock_guard lock(asking_);
  for (const Made& made : made_) {
    if (IsSolvedFor(made, time_s, light)) return made.clouds;
  }
  auto clouds = std::make_shared<const SolvedClouds>(Solved(time_s, light));
  if (made_.size() == kKept) made_.pop_front();
  made_.push_back({time_s, light.to_light, std::move(clouds)});
  return made_.back().clouds;
}

}  // namespace alpenglow::renderer
