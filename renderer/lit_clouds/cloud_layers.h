// SPDX-License-Identifier: MIT
// The clouds of a scene by time and light: fields with their phase functions and grey solutions.
#pragma once

#include <deque>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "atmosphere/time_place/time.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/scene_clouds.h"

namespace alpenglow::renderer {

/// Layers of clouds at one time, from the lowest to the highest base.
using CloudLayers = std::vector<SceneCloudField>;

/// Returns the phase functions of the droplets or crystals of a layer with which its light is solved,
/// at 550 nm.
[[nodiscard]] CloudPhases PhasesOf(const SceneCloudField& layer);
/// Returns them at other wavelengths. Below 300 and above 1000 nm they are those of the nearest end.
[[nodiscard]] std::vector<CloudPhases> PhasesByBand(const SceneCloudField& layer,
                                                    const std::vector<double>& wavelengths_nm);

/// Layers under one distant light. A light below kLowestCloudLight_deg counts as one in the zenith, as
/// long as the farthest cloud in sight can see it. Below that, nothing is solved for it.
struct SolvedClouds {
  std::shared_ptr<const CloudLayers> layers;
  std::vector<CloudLight> light;  // of each layer, over black ground
};

/// Returns how far clouds of a field shade others and the ground towards a sun below
/// kLowestCloudSun_deg. They do so in full up to 60 km, or up to where a sun of that height is seen past
/// the top of high clouds, and not at all from 120 km further on. A layer that went on without end would
/// never be lit from below.
[[nodiscard]] CloudLowSunOptions LowSunOver(const CloudField& field, double planet_radius_m);

/// Generates and solves the clouds of a scene on demand, and keeps the last solutions: a frame of a
/// series is metered in a small picture while the frame before it is developed, and the choice of
/// effects renders a picture many times. Safe to use from many threads.
class CloudsByTime {
 public:
  /// @param ground_m  height of the ground at the scene's place above the ellipsoid.
  /// @param planet_radius_m  of the air of the scene.
  CloudsByTime(const Scene& scene, double ground_m, double planet_radius_m)
      : scene_(scene), ground_m_(ground_m), radius_m_(planet_radius_m) {
    scene_.clouds = OverEllipsoid(scene_.clouds, ground_m);
  }

  /// Returns whether the scene has clouds.
  [[nodiscard]] bool HasAny() const;

  /// A distant light and the eye for which it lights clouds.
  struct Light {
    glm::dvec3 to_light;          // unit vector in the frame of the scene
    double eye_altitude_m = 0.0;  // above the ellipsoid
  };
  /// Returns the layers of a time in a light. Throws InputError as CloudFieldsOf and CloudLight do.
  [[nodiscard]] std::shared_ptr<const SolvedClouds> At(const UtcTime& time, const Light& light);

 private:
  struct Made {
    double time_s;
    glm::dvec3 to_light;
    std::shared_ptr<const SolvedClouds> clouds;
  };
  [[nodiscard]] SolvedClouds Solved(double time_s, const Light& light) const;
  [[nodiscard]] bool IsSolvedFor(const Made& made, double time_s, const Light& light) const;
  /// Returns the direction of the beam in a field; nothing for a light that no cloud in sight sees.
  [[nodiscard]] std::optional<glm::dvec3> BeamIn(const CloudField& field, const Light& light) const;

  Scene scene_;
  double ground_m_, radius_m_;
  std::mutex asking_;
  std::deque<Made> made_;  // oldest first
};

}  // namespace alpenglow::renderer
