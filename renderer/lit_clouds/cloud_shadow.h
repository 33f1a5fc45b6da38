// SPDX-License-Identifier: MIT
// The shadows of clouds: on the ground, on other media, and as shafts in the air.
//
// Depths of all layers (CloudSunDepths) give the transmittance T of clouds from a point to the light.
// Air scatters light that droplets or crystals have turned by a few degrees nearly as it scatters the
// beam, so that a ray in the air has the scaled transmittance T^s (cloud_optics.h: s = 1 - f w). It
// multiplies the light that terrain lets through. A path of sunlight describes a
// partial shade by the height x of the disk over an edge (SunlitPiece); a transmittance T is the
// height with SunlightOverEdge(x) = T.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/layer.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

/// Returns the x in [-1, 1] with SunlightOverEdge(x) = `sunlight`, within 1e-3 of sunlight.
/// @param sunlight  in [0, 1].
[[nodiscard]] double EdgeHeightFor(double sunlight);

/// Immutable; safe to use from many threads. Points and rays are in the frame of a scene.
class CloudShadow {
 public:
  /// The depths of a layer for one light.
  struct Layer {
    std::shared_ptr<const CloudSunDepths> sun;
    double scale;  // s
  };
  CloudShadow(std::vector<Layer> layers, double highest_cloud_m, double planet_radius_m);

  /// Returns the altitude of the highest cloud [m]; 0 without layers.
  [[nodiscard]] double highest_cloud_m() const { return highest_cloud_m_; }
  /// Returns the transmittance of all layers from a point to the light.
  [[nodiscard]] double Transmittance(const glm::dvec3& point) const;

  /// Distances between samples of the shadow along a ray.
  struct Steps {
    double shortest_m;    // distance of samples near the origin
    double per_distance;  // and far away, relative to the distance
    double reach_m;       // beyond it the mean of the layers holds
  };
  /// A beam near the horizon passes several clouds, so that it shows few edges, and a sample costs more.
  static constexpr Steps kByMap{50.0, 0.02, 120e3}, kUnderLowSun{100.0, 0.05, 40e3};
  /// Samples of a map are means around points beyond this distance.
  static constexpr double kSharpReach_m = 2000.0;

  /// Returns sunlight for the air on a ray behind terrain and clouds, by samples at kByMap or kUnderLowSun.
  /// @param path  sunlight behind terrain, within finite distances.
  [[nodiscard]] SunlitPath OnRay(const SunlitPath& path, const glm::dvec3& origin,
                                 const glm::dvec3& direction) const;

 private:
  /// Returns the scaled transmittance of all layers from a point of the air.
  /// @param is_sharp  whether it is not a mean around the point.
  [[nodiscard]] double ScaledTransmittance(const glm::dvec3& point, bool is_sharp) const;

  std::vector<Layer> layers_;
  double highest_cloud_m_, radius_m_;
  double mean_scaled_ = 1.0;  // transmittance
  Steps steps_ = kByMap;
};

}  // namespace alpenglow::renderer
